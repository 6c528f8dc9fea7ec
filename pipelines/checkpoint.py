"""Checkpoints: the whole state in HDF5, exact, atomic, checked when read; the last two are kept."""

from __future__ import annotations

import json
import logging
import re
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zrno.pipelines.observing import Solver
from zrno.pipelines.replacing import remove_left_overs, replacing
from zrno.translators.text import Fault, InputError

KEPT = 2
_INPUTS = "zrno inputs"
_log = logging.getLogger(__name__)


def save(path: Path | str, state: Mapping[str, Any], inputs: Mapping[str, str] | None = None) -> None:
    """Write a state: arrays as data sets, each with its CRC-32, numbers and strings as attributes.

    inputs: SHA-256 by file of what the run was started from. Raises TypeError for a value that is none of these.
    """
    import h5py

    # The latest layout has checksums of its own structure, so that any damage is found, and long attributes.
    with replacing(path) as temporary, h5py.File(temporary, "w", libver="latest") as file:
        file.attrs[_INPUTS] = json.dumps(dict(inputs or {}))
        for name, value in state.items():
            if isinstance(value, np.ndarray) and value.dtype.kind in "biuf":
                file.create_dataset(name, data=value).attrs["crc32"] = _crc(value)
            elif isinstance(value, (bool, int, float, str, np.generic)):
                file.attrs[name] = value
            else:
                raise TypeError(f"{name} is a {type(value).__name__}: a checkpoint holds arrays, numbers and strings")


def load_latest(directory: Path | str, inputs: Mapping[str, str] | None = None) -> dict[str, Any] | None:
    """The newest sound state in a folder, None where there is none; a damaged file is logged and passed over.

    inputs: SHA-256 by file; raises InputError where they are not those that the checkpoint was made from.
    """
    for path in reversed(_files(Path(directory))):
        try:
            state, made_from = _load(path)
        except (OSError, KeyError, ValueError, RuntimeError) as error:
            _log.warning("%s is damaged and passed over: %s", path, error)
            continue
        if inputs is not None:
            _compare(path, inputs, made_from)
        return state
    return None


def _load(path: Path) -> tuple[dict[str, Any], dict[str, str]]:
    import h5py

    state: dict[str, Any] = {}

    def collect(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset):
            state[name] = item[()] if item.shape == () else item[...]
            if _crc(state[name]) != item.attrs["crc32"]:
                raise ValueError(f"the checksum of {name} is wrong")

    with h5py.File(path, "r") as file:
        inputs = json.loads(file.attrs[_INPUTS])
        for name, value in file.attrs.items():
            if name != _INPUTS:
                state[name] = value.item() if isinstance(value, np.generic) else value
        file.visititems(collect)
    return state, inputs


def _compare(path: Path, inputs: Mapping[str, str], made_from: Mapping[str, str]) -> None:
    """Files are told by name and content: the folder may have moved."""
    now = {(Path(file).name, digest): file for file, digest in inputs.items()}
    then = {(Path(file).name, digest): file for file, digest in made_from.items()}
    names = {Path(file).name for file in inputs}
    expected = "the inputs of that run, or a run without --resume"
    faults = [
        Fault(file, 1, 1, f"not the input that {path.name} was made from", expected=expected)
        for key, file in now.items()
        if key not in then
    ]
    faults += [
        Fault(file, 1, 1, f"an input of {path.name} is not given now", expected=expected)
        for key, file in then.items()
        if key not in now and key[0] not in names
    ]
    if faults:
        raise InputError(faults)


def _crc(values: NDArray[Any]) -> int:
    return zlib.crc32(np.ascontiguousarray(values).data)


def _step(path: Path) -> int:
    return int(re.sub(r"\D", "", path.stem))


def _files(directory: Path) -> list[Path]:
    """The checkpoints of a folder, oldest first."""
    return sorted((p for p in directory.glob("checkpoint_*.h5") if re.fullmatch(r"checkpoint_\d+", p.stem)), key=_step)


class Checkpointer:
    """Observer: `checkpoint_<step>.h5` at simulated intervals or every so many steps, and when the run ends.

    interval: simulated time between checkpoints; every: steps between them (looked at whenever control returns from
    the solver, so at least that many); inputs: SHA-256 by file, kept in the checkpoint. `save` may be called at any
    time between steps, as when a run is interrupted.
    """

    exact = True

    def __init__(
        self,
        directory: Path | str,
        *,
        interval: float | None = None,
        every: int | None = None,
        inputs: Mapping[str, str] | None = None,
    ) -> None:
        self.interval = interval
        self._every = every
        self._directory = Path(directory)
        self._inputs = inputs
        self._saved = 0

    def start(self, solver: Solver) -> None:
        """Remove checkpoints that were not resumed from: they are of a run that is about to be made again."""
        self._directory.mkdir(parents=True, exist_ok=True)
        remove_left_overs(self._directory)
        self._saved = solver.step
        for path in _files(self._directory):
            if _step(path) > solver.step or solver.step == 0:
                path.unlink()

    def observe(self, solver: Solver) -> None:
        """A checkpoint where one is due."""
        if self.interval is not None or (self._every is not None and solver.step - self._saved >= self._every):
            self.save(solver)

    def finish(self, solver: Solver) -> None:
        """The state that the run ended with."""
        self.save(solver)

    def save(self, solver: Solver) -> None:
        """A checkpoint now, unless this step has one; all but the last two are removed after it stands."""
        path = self._directory / f"checkpoint_{solver.step:08d}.h5"
        if not path.exists():
            save(path, solver.checkpoint(), self._inputs)
            for old in _files(self._directory)[:-KEPT]:
                old.unlink()
        self._saved = solver.step
