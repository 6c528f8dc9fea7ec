"""Loads as block 407 has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from zrno.translators.femap.faces import find_faces
from zrno.translators.femap.loads import PRESSURE, TYPES_407
from zrno.translators.femap.text_out import CHUNK, line, pointed, real, set_numbers, title
from zrno.translators.femap.write_mesh import Mesh
from zrno.translators.model import BodyLoad, FaceLoad, Floats, Ints, Model, NodalLoad
from zrno.translators.report import Report

_TYPES = {"force": 1, "displacement": 2, "acceleration": 3, "velocity": 7}  # 407's
_PRESSURE_407 = next(old for old, new in TYPES_407.items() if new == PRESSURE)


@dataclass(slots=True)
class _Load:
    """A set of loads that is written as one."""

    body: BodyLoad | None = None
    nodal: list[NodalLoad] = field(default_factory=list)
    face: list[FaceLoad] = field(default_factory=list)


class Loads:
    """The loads of a model, in sets: as a FEMAP file had them, else all in one, since they act together."""

    def __init__(self, model: Model, mesh: Mesh, report: Report) -> None:
        self.model, self.mesh, self.report = model, mesh, report
        self.own = model.format == "femap"

    def lines(self) -> Iterator[str]:
        """The body of block 407."""
        sets: dict[tuple[int, str], _Load] = {}
        for nodal in self.model.nodal_loads:
            if self._can_say(nodal):
                sets.setdefault(self._key(nodal), _Load()).nodal.append(nodal)
        for face in self.model.face_loads:
            if face.direction:
                self.report.drop("tractions on faces", len(face.faces), "block 407 has pressures alone")
            else:
                sets.setdefault(self._key(face), _Load()).face.append(face)
        free = list(sets.values())
        for body in self.model.body_loads:
            if body.parts is not None:
                self.report.drop("body loads", 1, "on some parts: FEMAP's act on all")
            elif free and free[0].body is None:
                free.pop(0).body = body
            else:
                sets[(0, f"gravity {len(sets)}")] = _Load(body)
        numbers = set_numbers([number for number, _ in sets])
        for number, ((_, name), load) in zip(numbers, sets.items(), strict=True):
            yield from self._load_set(number, name, load)

    def _key(self, load: NodalLoad | FaceLoad) -> tuple[int, str]:
        return (load.id, load.name) if self.own else (1, "")

    def _can_say(self, load: NodalLoad) -> bool:
        if load.birth or load.death is not None:
            self.report.approximate("loads on nodes", len(load.nodes), "that begin or end: always")
        if load.system and load.system not in self.model.systems:
            self.report.drop("loads on nodes", len(load.nodes), f"system {load.system} is not there")
        elif load.kind not in (*_TYPES, "temperature"):
            self.report.drop("loads on nodes", len(load.nodes), f"block 407 has no {load.kind}")
        else:
            return True
        return False

    def _load_set(self, number: int, name: str, load: _Load) -> Iterator[str]:
        gravity, function = (load.body.acceleration, load.body.curve or 0) if load.body else ((0.0, 0.0, 0.0), 0)
        yield f"{number},\n" + title(name, self.report)
        yield f"0,0.,0,{int(load.body is not None)},0,\n" + line((*map(float, gravity), *[function] * 3))
        yield "0.,0.,0.,0,0,0,\n0.,0.,0.,\n0.,0.,0.,\n0.,0.,0.,\n0.,0.,0.,0.,\n0.,0.,0.,0.,\n0,0,0,\n0,0,0,\n"
        yield "0.,0.,0.,0.,\n0.,0.,0.,\n0.,0.,0.,0.,0.,0.,\n0.,0.,0.,0.,0.,0.,\n"
        yield "0,0,0,0,0,0,0,0,0,\n0,0,0,0,0,0,0,0,\n0,0,0,0,0,0,0,\n0,0,0,0,0,0,0,\n0,0,0,0,0,\n"
        for nodal in load.nodal:
            if nodal.kind != "temperature":
                yield from self._nodal(nodal)
        for face in load.face:
            yield from self._pressure(face)
        yield "-1,-1,-1,-1,-1,-1,\n"
        for nodal in load.nodal:
            if nodal.kind == "temperature":
                ids = self.mesh.node_ids[nodal.nodes].tolist()
                curve = nodal.curve or 0
                pairs = zip(ids, nodal.values.tolist(), strict=True)
                yield "".join([f"{n},10,1,{real(value)},0.,{curve},\n" for n, value in pairs])
        yield "-1,-1,-1,0.,0.,0,\n-1,-1,-1,0.,0.,0,\n"

    def _nodal(self, load: NodalLoad) -> Iterator[str]:
        """A record a node: its degrees of freedom that stand together in the load."""
        if not len(load.nodes):
            return
        new = np.ones(len(load.nodes), bool)
        new[1:] = (load.nodes[1:] != load.nodes[:-1]) | (load.dofs[1:] <= load.dofs[:-1])
        record = np.cumsum(new) - 1
        values, flags = np.zeros((record[-1] + 1, 6)), np.zeros((record[-1] + 1, 6), np.int64)
        good = (load.dofs >= 1) & (load.dofs <= 6)
        self.report.drop("loads on nodes", int((~good).sum()), "not of a degree of freedom 1 to 6")
        values[record[good], load.dofs[good] - 1] = load.values[good]
        flags[record[good], load.dofs[good] - 1] = 1
        ids = self.mesh.node_ids[load.nodes[new]]
        yield from self._records(ids, _TYPES[load.kind], load.system, load.curve, flags, values)

    def _pressure(self, load: FaceLoad) -> Iterator[str]:
        ids, faces, signs = find_faces(self.mesh, load.faces)
        found = ids > 0
        self.report.drop("pressures on faces", int((~found).sum()), "that no element has, or a pyramid's side")
        values = load.values.mean(axis=1) if load.values.ndim > 1 else load.values
        if load.values.ndim > 1 and (np.ptp(load.values, axis=1) != 0).any():
            self.report.approximate("pressures on faces", len(values), "that vary over a face: their mean")
        flags, table = np.zeros((int(found.sum()), 6), np.int64), np.zeros((int(found.sum()), 6))
        flags[:, 0], table[:, 0] = faces[found], (values * signs)[found]
        yield from self._records(ids[found], _PRESSURE_407, 0, load.curve, flags, table)

    @staticmethod
    def _records(ids: Ints, kind: int, system: int, curve: int | None, flags: Ints, values: Floats) -> Iterator[str]:
        """Records of twelve lines; flags, values: (n, 6)."""
        end = "0.,0,0,0,\n0,0,0,0,0,0,0,\n0,0,0,\n0.,0.,0.,\n"
        for first in range(0, len(ids), CHUNK):
            some = slice(first, first + CHUNK)
            heads = [f"{n},{kind},10,1,{system},{curve or 0},\n0.,0.,\n" for n in ids[some].tolist()]
            pairs = zip(flags[some].tolist(), values[some].tolist(), strict=True)
            bodies = ["".join([f"{f},{v!r},\n" for f, v in zip(*pair, strict=True)]) for pair in pairs]
            yield pointed("".join([h + b + end for h, b in zip(heads, bodies, strict=True)]))
