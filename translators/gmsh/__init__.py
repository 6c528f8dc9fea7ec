"""gmsh: meshes (.msh) read and written without the gmsh package, and geometry (.geo) meshed with it."""

from zrno.translators.gmsh.geo import mesh_geo
from zrno.translators.gmsh.read import read
from zrno.translators.gmsh.write import write

__all__ = ["mesh_geo", "read", "write"]
