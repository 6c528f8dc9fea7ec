"""gmsh: meshes (.msh) read without the gmsh package, and geometry (.geo) meshed with it."""

from zrno.translators.gmsh.geo import mesh_geo
from zrno.translators.gmsh.read import read

__all__ = ["mesh_geo", "read"]
