from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from zrno.translators import Model, Report, read, write
from zrno.translators.formats import find
from zrno.translators.neu import kind_of


def test_importing_loads_nothing_heavy() -> None:
    code = (
        "import sys, zrno.translators as t; t.read, t.write, t.to_particles, t.help_settings\n"
        "heavy = {'gmsh', 'meshio', 'vtk', 'vtkmodules', 'numba', 'scipy', 'h5py', 'matplotlib', 'pyvista', 'yaml'}\n"
        "print(*(heavy & set(sys.modules)))"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == ""


def test_the_package_alone_loads_no_numpy() -> None:
    code = "import sys, zrno.translators; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("   -1\n   100\n<NULL>\n4.41\n   -1\n", "a mesh without nodes; expected block 403"),
        ("25       0       0       1       0       0       0       0       0\ntitle\n26 0 0 1 9 4 1 1 0\n",
         "this is a Patran neutral file, which is not read; expected the mesh as gmsh .msh or as FEMAP neutral file"),
        ("8\n  0.0 0.0 0.0\n  1 0 1e3\n", "this is a Netgen neutral file, which is not read; expected the mesh as"),
        ("*KEYWORD\n", "neither a FEMAP nor a Gambit neutral file; expected FEMAP (-1, then 100) or Gambit (CONTROL"),
        ("-1\n", "neither a FEMAP nor a Gambit neutral file"),
        ("\0\0\0\n\xff\n", "neither a FEMAP nor a Gambit neutral file"),
        ("        CONTROL INFO 1.3.0\nENDOFSECTION\n", "not the counts of a mesh"),
    ],
)  # fmt: skip
def test_neutral_files_are_told_apart(faults, text: str, said: str) -> None:
    assert said in faults(read, text, name="a.neu")[0]


def test_neutral_files_of_programs(shared: Path) -> None:
    kinds = {path.name: kind_of(path.read_bytes()[:8192]) for path in (shared / "samples").glob("*/*.neu")}
    assert kinds == {
        path.name: folder for folder in ("femap", "gambit") for path in (shared / "samples" / folder).glob("*.neu")
    }
    assert read(shared / "samples/gambit/cubeK5.neu").format == "gambit"
    assert read(shared / "samples/femap/pak_3de.neu").format == "femap"


def test_a_mesh_under_another_name(tmp_path: Path, shared: Path) -> None:
    (tmp_path / "mesh.neu").write_bytes((shared / "samples/msh/gridap_square.msh").read_bytes())
    assert find(tmp_path / "mesh.neu").name == "msh"
    assert read(tmp_path / "mesh.neu").format == "msh"


def test_a_keyword_deck_under_another_name(tmp_path: Path) -> None:
    (tmp_path / "piece.inc").write_text("$ a comment\n*KEYWORD\n*NODE\n1,2.,3.,4.\n")
    assert read(tmp_path / "piece.inc").xyz.tolist() == [[2.0, 3.0, 4.0]]


def test_targets_that_are_not_written(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"not written; expected one of \.mcm, \.msh, \.k, .*\.neu, .*\.dat"):
        write(Model(), tmp_path / "a.stl")


def test_vtu_goes_out_and_comes_back(tmp_path: Path, shared: Path) -> None:
    model = read(shared / "samples/msh/gen_slab_22a_o2.msh")
    report = write(model, tmp_path / "a.vtu")
    assert [item.what for item in report.dropped] == ["node sets"]
    again = read(tmp_path / "a.vtu")
    assert np.array_equal(again.xyz, model.xyz)
    assert again.element_counts() == model.element_counts()
    for block, other in zip(model.blocks, again.blocks, strict=True):
        assert np.array_equal(block.nodes, other.nodes)
        assert np.array_equal(block.part, other.part)
    assert list(again.parts) == [1]
    assert [path.name for path in tmp_path.iterdir()] == ["a.vtu"]


def test_vtu_of_particles(tmp_path: Path, deck) -> None:
    (tmp_path / "a.mcm").write_text(deck())
    assert not write(read(tmp_path / "a.mcm"), tmp_path / "a.vtu")
    assert read(tmp_path / "a.vtu").element_counts() == {"point1": 4}
    with pytest.raises(ValueError, match="neither elements nor particles"):
        write(Model(), tmp_path / "b.vtu")


def test_what_meshio_reads(tmp_path: Path) -> None:
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    model = read(tmp_path / "a.off")
    assert (model.element_counts(), model.dimension, list(model.parts)) == ({"tri3": 1}, 2, [1])


@pytest.mark.parametrize("name", ["a.off", "a.xyzzy", "a.stl", "noextension"])
def test_what_meshio_cannot_read(faults, name: str) -> None:
    assert "meshio cannot read the file" in faults(read, "nonsense\n", name=name)[0]


def test_a_report() -> None:
    report = Report()
    assert not report
    report.drop("springs", 0, "nowhere")
    assert not report
    report.approximate("curves", 2, "as tables")
    other = Report()
    other.drop("springs", 3, "no place")
    report.extend(other)
    assert report
    assert report.as_dict() == {
        "approximated": [{"what": "curves", "count": 2, "where": "as tables"}],
        "dropped": [{"what": "springs", "count": 3, "where": "no place"}],
    }
