"""gmsh geometry (.geo), meshed through the gmsh package."""

from __future__ import annotations

import re
import signal
import tempfile
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from zrno.translators.gmsh.read import read as read_msh
from zrno.translators.model import Model
from zrno.translators.text import Fault, InputError, read_bytes

_PLACE = re.compile(r"line (\d+)\s*:\s*(.*)")
_SYSTEM_LIBRARIES = "libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1"


def read(path: Path | str, *, numbers: Mapping[str, float] | None = None) -> Model:
    """Mesh a geometry and read the mesh. numbers: as for `mesh_geo`."""
    mesh = mesh_geo(path, numbers=numbers)
    try:
        model = read_msh(mesh)
    finally:
        mesh.unlink()
        mesh.parent.rmdir()
    model.title, model.format = Path(path).stem, "geo"
    for part in model.parts.values():
        part.source = None  # the mesh's lines are gone
    for nodes in model.node_sets:
        nodes.source = None
    model.warnings = [warning.replace(str(mesh), str(path)) for warning in model.warnings]
    return model


def mesh_geo(path: Path | str, *, numbers: Mapping[str, float] | None = None) -> Path:
    """Mesh a geometry in its highest dimension; returns a temporary .msh, alone in a folder that the caller removes.

    numbers: values of the script's DefineConstant parameters by name, as gmsh's option -setnumber.
    Raises InputError with gmsh's messages; ImportError, saying what to install, where gmsh cannot be loaded.
    """
    data = read_bytes(path)
    if not data.endswith(b"\n"):
        last = data.rsplit(b"\n", 1)[-1].decode("utf-8", "replace").strip()
        line = 1 + data.count(b"\n")
        raise InputError(
            [Fault(str(path), line, 1, "gmsh skips a last line without an end", last, "a newline after it")]
        )
    gmsh = _gmsh()
    with _pipe_signal_kept():
        gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        # the option -setnumber would outlive gmsh.finalize, and gmsh.open would forget the parser's numbers
        for name, value in (numbers or {}).items():
            gmsh.parser.setNumber(name, [float(value)])
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.logger.start()
        try:
            gmsh.merge(str(path))
            if not len(gmsh.model.mesh.getNodes()[0]):
                gmsh.model.mesh.generate(gmsh.model.getDimension())
        except Exception as error:  # gmsh raises nothing narrower
            raise InputError(_faults(str(path), [*gmsh.logger.get(), f"Error   : {error}"])) from error
        if not len(gmsh.model.mesh.getNodes()[0]):
            raise InputError(
                [Fault(str(path), 1, 1, "the geometry makes no mesh", expected="points, lines, surfaces, volumes")]
            )
        target = Path(tempfile.mkdtemp(prefix="zrno-")) / "mesh.msh"
        gmsh.option.setNumber("Mesh.MshFileVersion", 4.1)
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.write(str(target))
    finally:
        gmsh.parser.clear()
        gmsh.finalize()
    return target


@contextmanager
def _pipe_signal_kept() -> Iterator[None]:
    """Put back what a broken pipe does: an exception in Python; gmsh resets it to the end of the process.

    Only the main thread may set it; elsewhere, and where there is no such signal, gmsh has its way.
    """
    number = getattr(signal, "SIGPIPE", None)
    if number is None or threading.current_thread() is not threading.main_thread():
        yield
        return
    handler = signal.getsignal(number)
    try:
        yield
    finally:
        if handler is not None:  # None: set by other means than Python's
            signal.signal(number, handler)


def _gmsh() -> Any:
    try:
        import gmsh
    except (ImportError, OSError) as error:
        raise ImportError(
            f"the gmsh package cannot be loaded ({error}); its libraries: apt-get install -y {_SYSTEM_LIBRARIES}"
        ) from error
    return gmsh


def _faults(path: str, messages: list[str]) -> list[Fault]:
    """gmsh's errors as faults; those with a line first said."""
    faults: dict[str, Fault] = {}
    for message in messages:
        kind, _, text = message.partition(":")
        if kind.strip() != "Error":
            continue
        match = _PLACE.search(text)
        said = match[2] if match else text.strip()
        faults.setdefault(said, Fault(path, int(match[1]) if match else 1, 1, f"gmsh: {said}"))
    placed = [fault for fault in faults.values() if fault.line > 1]
    return (placed or list(faults.values()))[:20]
