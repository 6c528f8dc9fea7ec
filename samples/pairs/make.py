"""Makes the pairs of decks: the same block and plate by way of .msh, .k and .neu, and one deck edited. Needs gmsh."""

from __future__ import annotations

import tempfile
from pathlib import Path

from zrno.pipelines.convert import convert
from zrno.translators import load_settings, read, write

HERE = Path(__file__).parent


def make(folder: Path) -> list[Path]:
    """All pairs into a folder; returns their files."""
    plate, block = (load_settings(HERE / f"{name}.yaml") for name in ("plate", "block"))
    made = []
    with tempfile.TemporaryDirectory() as temporary:
        for kind in ("msh", "k", "neu"):
            for name, settings, target in (("plate", plate, "dat"), ("block", block, "mcm")):
                mesh, deck = Path(temporary) / f"{name}.{kind}", folder / f"{kind}.{target}"
                convert([HERE / f"{name}.geo"], mesh)
                filled = ("solids", 2.0) if target == "mcm" else (None, None)
                convert([mesh], deck, parts=[1], particles=filled[0], spacing=filled[1], settings=settings)
                made.append(deck)
    return made + edited(folder)


def edited(folder: Path) -> list[Path]:
    """The pair by way of .msh, read back and changed: a slower, heavier block with friction on a thicker plate."""
    grain, steel = read(folder / "msh.mcm", paired=True), read(folder / "msh.dat")
    assert grain.particles is not None
    assert grain.particles.velocity is not None
    assert grain.particle_control is not None
    grain.title = "a slower and heavier block, with friction"
    grain.particles.velocity[:, 0] = grain.particles.velocity[:, 2] = -2.0
    grain.particle_control.friction = 0.4, 0.3
    grain.particle_control.dialect = "2019-10"
    grain.materials[1].density *= 2.0
    grain.materials[1].mass *= 2.0
    steel.title = "a plate of 1.5 mm"
    for group in steel.blocks:
        group.data["thickness"] = group.data["thickness"] * 1.5
    files = [folder / "edited.dat", folder / "edited.mcm"]
    write(steel, files[0])
    write(grain, files[1])
    return files


if __name__ == "__main__":
    for file in make(HERE):
        print(file)
