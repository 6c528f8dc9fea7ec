"""Every real file beside the repository: the counts that its list gives, and a deck made of it or a clear answer."""

from __future__ import annotations

import csv
import importlib.util
import re
import sys
from collections import Counter
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from zrno.pipelines.convert import convert
from zrno.pipelines.info import info
from zrno.translators import InputError, load_settings, read
from zrno.translators.elements import TABLE

# File -> what converting it to a deck gives: "" for a deck, else what is said. Volumes and areas go to .dat, particles
# to .mcm. Meshes without materials take those of SETTINGS.
NO_NODE, LACKS = "has a node that is not there", "lacks what it names"
OUTCOMES: dict[str, str] = {
    "lsdyna/birdball.k": "",
    "lsdyna/bird.k": "",
    "lsdyna/bracket.k": "",
    "lsdyna/ex13_thick_shell.k": "",
    "lsdyna/airfilled_sphere_reduced.k": NO_NODE,
    "lsdyna/dynakw_thick.k": NO_NODE,
    "lsdyna/dynakw_sets.k": LACKS,
    "lsdyna/dynakw_parameter_test.k": "no elements",
    "lsdyna/dynakw_joint_revolute.k": "",
    "lsdyna/plate_shatter_reduced.k": NO_NODE,
    "lsdyna/expand_test/bird_B.k": "control_cards.k:38:1: error: there is no such file to include (mesh.k)",
    "lsdyna/expand_test/control_cards.k": ":38:1: error: there is no such file to include (mesh.k)",
    "lsdyna/expand_test/fol/mesh.k": "",
    "lsdyna/multiline_comment.k": LACKS,
    "lsdyna/isph.k": "no elements",
    "lsdyna/elementary_transform.k": "",
    "lsdyna/taylor_bar_mesh.k": "",
    "lsdyna/beer_can_mesh.k": "",
    "lsdyna/ball_plate.k": "",
    "lsdyna/frf_solid.k": "",
    "lsdyna/bolt_a/mainboltaexpl.k": ":89:1: error: there is no such file to include (missing_geometry.k)",
    "lsdyna/bolt_a/includes.k": "parameter dtprestr is not defined",
    "lsdyna/bolt_a/bolted_connection_a.k": ":91:22: error: parameter dtprestr is not defined",
    "lsdyna/bolt_a/control_explicit.k": "no elements",
    "lsdyna/bolt_a/submodels/loading/prescribed_motion.k": ":7:1: error: an included file is outside the folder",
    "lsdyna/bolt_a/submodels/material_props.k": "no elements",
    "lsdyna/mlp6_nodes.dyn": "no elements",
    "lsdyna/mlp6_elems.dyn": "1000 elements point at nodes that are not in the file",
    "lsdyna/weldform_2el.k": "",
    "lsdyna/weldform_cyl_hex.k": "",
    "lsdyna/topalovic_kupa1.k": "",
    "lsdyna/gen/long_y.k": "",
    "lsdyna/gen/i10_y.k": "",
    "mcm/kupa1.mcm": ":869:5: error: velocity card past the last particle 802",
    "mcm/newhope3.mcm": ":4364:5: error: velocity card past the last particle 4295",
    "mcm/kipkupa.mcm": "",
    "mcm/morris.mcm": "",
    "mcm/cesmavoda.mcm": "",
    "pak-dat/1d.dat": "",
    "pak-dat/mmkoraci41.dat": "",
    "pak-dat/pr1_3DMM.dat": "",
    "pak-dat/kipkupa.dat": "",
    "pak-dat/3de.dat": "",
    "femap/pak_3de.neu": "",
    "femap/pak_kockav1.neu": "",
    "femap/pak_tac11.neu": "",
    "femap/pakf_bakiheart.neu": "",
    "femap/emsi_simple.neu": "",
    "pakf-dat/KANAL.dat": "a deck of PAK-F or PAK-KTM (fluid, transport), which is not read",
    "gambit/cubeK5.neu": "",
    "gambit/kovA1.neu": "",
    "gambit/Maxwell2.neu": "",
    "msh/mfem_compass.msh": "",
    "msh/mfem_periodic_cube.msh": "",
    "msh/mfem_t1_v4.msh": "",
    "msh/mfem_indheat_40.msh": "",
    "msh/mfem_indheat_41.msh": "",
    "msh/mfem_p2_prism.msh": "",
    "msh/gridap_square.msh": "",
    "msh/gridap_two_tets.msh": "",
    "msh/gridap_demo.msh": "",
    "msh/gen_box_22a.msh": "",
    "msh/gen_box_22b.msh": "",
    "msh/gen_slab_41a.msh": "",
    "msh/gen_slab_22a_o2.msh": "",
}
# Where the list counts something else: the file alone, without what it includes, or with gmsh, which reads nothing.
NOT_ALONE = {"lsdyna/bolt_a/mainboltaexpl.k", "lsdyna/bolt_a/includes.k", "msh/mfem_indheat_40.msh"}
SETTINGS = {f"materials.*.{key}": 1 for key in ("density", "E", "thickness", "area")} | {
    "materials.*.law": "elastic",
    "materials.*.nu": 0.3,
}


@pytest.fixture
def samples(shared: Path) -> Path:
    """Where the files are."""
    return shared / "samples"


def load_module(name: str) -> ModuleType:
    """A module beside this one, by its file."""
    spec = importlib.util.spec_from_file_location(Path(name).stem, Path(__file__).parent / name)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def listed(samples: Path) -> dict[str, str]:
    """The counts that the list gives of each file."""
    with (samples / "MANIFEST.tsv").open(encoding="utf-8") as file:
        rows = csv.DictReader(file, delimiter="\t")
        return {row["file"]: row["counts (own counting; cross-check in brackets)"] for row in rows}


def test_every_file_has_its_outcome(samples: Path) -> None:
    assert set(OUTCOMES) == set(listed(samples))


def settings_of(summary: dict[str, Any]) -> dict[str, object]:
    """Materials for a mesh that has none, or one of a law that no deck has."""
    laws = [material["law"] for material in summary["materials"].values()]
    return {} if laws and all(laws) else SETTINGS


@pytest.mark.parametrize("name", OUTCOMES)
def test_outcome(samples: Path, tmp_path: Path, name: str) -> None:
    path, said = samples / name, OUTCOMES[name]
    particles = path.suffix == ".mcm" or name.endswith("kupa1.k")
    target = tmp_path / ("deck.mcm" if particles else "deck.dat")
    given = {}
    if not said and path.suffix not in (".mcm", ".dat"):
        given = settings_of(info(path))
    settings = load_settings(overrides=given) if given else None
    if said:
        with pytest.raises((InputError, ValueError)) as caught:
            convert([path], target, settings=settings)
        assert said in str(caught.value)
        assert not target.exists()
        return
    convert([path], target, settings=settings)
    # a reader that shares nothing with ours takes it
    strict = load_module("strict_mcm.py" if particles else "pak/strict.py")
    deck = strict.read(target)
    if not particles:
        for k, (kind, *_) in enumerate(deck.groups):
            if kind == 3:
                assert (strict.jacobians(deck, k) > 0).all()
    # what we wrote is read, and written again to the same bytes
    again = target.with_stem("again")
    convert([target], again)
    assert again.read_bytes() == target.read_bytes()


_DIMENSION = {"Point": 0, "Line": 1, "Triangle": 2, "Quadrilateral": 2, "Tetrahedron": 3, "Hexahedron": 3, "Prism": 3}


def expected_counts(counts: str) -> Counter[str]:
    """Nodes, particles, and elements by dimension, of a row of the list."""
    found: Counter[str] = Counter()
    if "gmsh:" in counts:
        gmsh = counts.split("gmsh:")[1]
        found["nodes"] = int(re.findall(r"nodes=(\d+)", gmsh)[0])
        for kind, count in re.findall(r"([A-Z]\w+)[ 0-9]*=(\d+)", gmsh):
            found[f"elements {_DIMENSION[kind]}"] += int(count)
        return found
    counts = counts.split(" [")[0]
    for pattern, key in (
        (r"\bnodes=(\d+)", "nodes"), (r"NUMNP=(\d+)", "nodes"), (r"\bNP=(\d+)", "nodes"),
        (r"NP\(card\)=(\d+)", "particles"),
        (r"\bsph=(\d+)", "particles"), (r"\bbeam=(\d+)", "elements 1"), (r"\bshell=(\d+)", "elements 2"),
        (r"\bsolid=(\d+)", "elements 3"), (r"\btshell=(\d+)", "elements 3"), (r"hex8=(\d+)", "elements 3"),
        (r"quad4=(\d+)", "elements 2"),
    ):  # fmt: skip
        found[key] += sum(map(int, re.findall(pattern, counts)))
    for netip, count in re.findall(r"\((\d+), (\d+)\)\]", counts) if "NETIP" in counts else ():
        found[f"elements {({'1': 1, '3': 3, '84': 2})[netip]}"] += int(count)
    for kind, nodes, count in re.findall(r"\((\d), (\d)\): (\d+)", counts):
        found[f"elements {({'6': 3, '3': 2})[kind]}"] += int(count) * (nodes == {"6": "4", "3": "3"}[kind])
    return +found


@pytest.mark.parametrize("name", [name for name in OUTCOMES if name not in NOT_ALONE and not name.startswith("pakf")])
def test_counts_of_info(samples: Path, name: str) -> None:
    try:
        summary = info(samples / name, allow_outside=True)
    except InputError as error:
        if "include" in str(error) or "parameter" in str(error):
            pytest.skip("it needs files or parameters that are not there")
        raise
    found: Counter[str] = Counter(nodes=summary["nodes"], particles=summary["particles"])
    for kind, count in summary["elements"].items():
        found[f"elements {TABLE[kind].dimension}"] += count
    expected = expected_counts(listed(samples)[name])
    assert +found == expected


def test_the_cone_of_the_dissertation(samples: Path, tmp_path: Path) -> None:
    """From the author's mesh to his deck's coordinates and boundary codes, by our converter and a strict reader."""
    convert([samples / "lsdyna/topalovic_kupa1.k"], tmp_path / "cone.mcm", parts=["1"])
    deck = load_module("strict_mcm.py").read(tmp_path / "cone.mcm")
    his = read(samples / "mcm/kipkupa.mcm", paired=True).particles
    assert his is not None
    assert deck.x == [tuple(row) for row in his.x.tolist()]
    assert deck.bc == his.bc.tolist()
    both = tmp_path / "both.mcm"
    convert([samples / "lsdyna/topalovic_kupa1.k"], both)
    assert load_module("strict_mcm.py").read(both).bc == [0] * 478 + [7] * 324


def test_the_plate_of_the_dissertation_keeps_its_meaning(samples: Path, tmp_path: Path, same) -> None:
    convert([samples / "pak-dat/kipkupa.dat"], tmp_path / "plate.dat")
    assert same(read(tmp_path / "plate.dat"), read(samples / "pak-dat/kipkupa.dat"))
