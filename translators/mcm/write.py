"""Writer of .mcm decks, version 2: what MCM reads, in its columns, cards headed by a comment naming their fields."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from zrno.translators.card_text import CardText
from zrno.translators.mcm import cards as layouts
from zrno.translators.mcm.laws import eos_rows, property_values
from zrno.translators.model import Ints, Material, Model, ParticleControl, Particles
from zrno.translators.report import Report
from zrno.translators.text import Layout, write_atomically

_CHUNK = 100_000  # particles formatted at a time
_LONGEST_NAME = 12  # of a deck on MCM's command line, without the extension


def write(model: Model, path: Path | str, *, dialect: str | None = None) -> Report:
    """Write the model's particles as a deck; the file appears whole or not at all.

    dialect: "2.07", "2019-08" or "2019-10"; by default the model's own where it can say the friction, else 2019-10.
    Returns what the deck cannot say. Raises ValueError for a model that no deck can be made of.
    """
    writer = _Writer(model, dialect)
    write_atomically(path, writer.chunks())
    if len(Path(path).stem) > _LONGEST_NAME:
        writer.report.notes.append(
            f"{Path(path).name}: the original program takes names of at most {_LONGEST_NAME} characters before .mcm"
        )
    return writer.report


class _Writer:
    def __init__(self, model: Model, dialect: str | None) -> None:
        if model.particles is None or model.particle_control is None or not len(model.particles):
            raise ValueError("a particle deck needs particles and control cards: fill the mesh with particles first")
        self.model = model
        self.particles: Particles = model.particles
        self.control: ParticleControl = model.particle_control
        self.materials: list[Material] = list(model.materials.values())
        self.report = Report()
        self._text = CardText(self.report)
        self._check()
        self.dialect = self._choose_dialect(dialect)
        for kind, count in model.element_counts().items():
            self.report.drop(f"{kind} elements", count, "an .mcm deck holds particles alone")
        self.report.drop("node sets", len(model.node_sets), "an .mcm deck has none")

    def chunks(self) -> Iterator[bytes]:
        """The deck's text, in pieces; the report is complete after the last."""
        head = [
            *self._title(),
            *self._control(),
            *self._materials(),
            *self._heading(layouts.particle(self.control.dimension)),
        ]
        yield _joined(head)
        yield from self._particles()
        yield from self._extra()
        yield _joined([*self._history(), *self._velocities(), *self._after()])
        self._text.report_rounded()

    def _check(self) -> None:
        c, p = self.control, self.particles
        if [m.id for m in self.materials] != list(range(1, len(self.materials) + 1)):
            raise ValueError("the materials of a particle deck are numbered 1, 2, 3, ...")
        for material in self.materials:
            if material.law not in layouts.LAWS:
                raise ValueError(f"material {material.id}: an .mcm deck cannot say the law {material.law!r}")
            eos = self.model.equations_of_state.get(-1 if material.eos is None else material.eos)
            if layouts.LAWS[material.law].eos != (eos is not None):
                need = "needs an" if layouts.LAWS[material.law].eos else "takes no"
                raise ValueError(f"material {material.id}: the {material.law} law {need} equation of state")
            if eos is not None and eos.law not in layouts.EQUATIONS_OF_STATE:
                raise ValueError(f"material {material.id}: an .mcm deck has no equation of state {eos.law!r}")
        if p.material.min() < 1 or p.material.max() > len(self.materials):
            raise ValueError("a particle's material is not among the deck's materials")
        if c.contact and len(c.contact_laws) != len(self.materials):
            raise ValueError("contact 1 (repulsive force) needs a strength and an exponent for each material")
        if (p.rho is None) != (p.e is None):
            raise ValueError("density and energy of the particles are given together or not at all")
        for values in (p.x, p.velocity, p.mass, p.h, p.rho, p.e):
            if values is not None and not np.isfinite(values).all():
                raise ValueError("a particle has a value that is not finite")

    def _choose_dialect(self, asked: str | None) -> str:
        """The dialect written; what an asked for one cannot say is reported."""
        c = self.control
        sayable = {
            "2.07": c.friction is None and c.fluid_friction is None and not c.birth_death,
            "2019-08": c.fluid_friction is None and not c.birth_death,
            "2019-10": True,
        }
        if asked is None:
            return c.dialect if sayable[c.dialect] else "2019-10"
        if asked not in sayable:
            raise ValueError(f"no such dialect: {asked}; expected one of {', '.join(layouts.DIALECTS)}")
        if not sayable[asked]:
            lost = {"fluid friction": c.fluid_friction is not None, "birth and death": c.birth_death > 0,
                    "friction": c.friction is not None and asked == "2.07"}  # fmt: skip
            for what, there in lost.items():
                self.report.drop(what, int(there), f"dialect {asked} has no place for it: write 2019-10")
        return asked

    # Text of cards

    def _line(self, layout: Layout, values: dict[str, Any], what: str) -> str:
        return self._text.line(layout, values, what)

    @staticmethod
    def _heading(layout: Layout, title: str = "") -> list[str]:
        """A comment that names the fields, at most 80 columns."""
        return [f"$ {title}: {' '.join(layout.fields)}"[:80] if title else f"$ {' '.join(layout.fields)}"[:80]]

    # Sections, in the deck's order

    def _title(self) -> list[str]:
        title = self._text.ascii(self.model.title, 78, "title")
        if title[:1] in ("*", "$"):
            title = " " + title  # else the title would be a comment
        return [self._line(layouts.TITLE, {"title": title, "version": 2}, "title")]

    def _control(self) -> Iterator[str]:
        c, p, count = self.control, self.particles, len(self.particles)
        base = c.base_acceleration or (0.0, 0.0, 0.0)
        rows: list[dict[str, Any]] = [
            {"axopt": 4 if c.axisymmetric else c.dimension, "disctype": c.discretisation,
             "nummat": len(self.materials), "np": count, "max_np": max(c.max_particles, count)},
            {"endtime": c.end_time, "tssf": c.step_factor, "itss": c.initial_step, "drelax": c.dynamic_relaxation},
            {"stpltime": c.output_interval, "state_opt": c.state_option, "thpltime": c.history_interval,
             "thnode": len(c.history_particles), "transducers": len(c.transducers),
             "status": c.status_interval, "restart": c.restart_interval, "run_restart": c.run_restart},
            {"keep_files": c.keep_files, "init_v": p.velocity is not None or self.model.velocity_overrun > 0,
             "massopt": p.mass is not None, "init_h": p.h is not None, "init_rhoe": p.rho is not None},
            {"contact": c.contact, "tcrit": c.step_option, "veloc_opt": c.velocity_option,
             "symmetry": c.planes is not None, "nthpx": base[0] != 0, "nthpy": base[1] != 0, "nthpz": base[2] != 0},
            {"h_opt": c.h_option, "kernel": c.kernel, "maxnbr": c.max_neighbours},
        ]  # fmt: skip
        for number, (layout, row) in enumerate(zip(layouts.CONTROL, rows, strict=True), 1):
            yield from self._heading(layout, f"control card {number}")
            yield self._line(
                layout,
                {name: int(v) if isinstance(v, bool) else v for name, v in row.items()},
                f"control card {number}",
            )
        yield from self._card_7()

    def _card_7(self) -> Iterator[str]:
        c = self.control
        static, dynamic = c.friction or (0.0, 0.0)
        friction = self._line(layouts.FRICTION, {"static_friction": static, "dynamic_friction": dynamic}, "friction")
        if self.dialect == "2.07":
            yield from ("$ control card 7: blank", "")
        elif self.dialect == "2019-08":
            yield from (*self._heading(layouts.FRICTION, "control card 7"), friction)
        else:
            kind = 2 if c.fluid_friction is not None else int(c.friction is not None)
            yield from self._heading(layouts.CARD_7_OPTIONS, "control card 7")
            options = {"birth_death": c.birth_death, "contact_option": kind, "plane_particle": c.plane_particle}
            yield self._line(layouts.CARD_7_OPTIONS, options, "control card 7")
            if kind == 1:
                yield from (*self._heading(layouts.FRICTION), friction)
            elif kind == 2:
                yield from self._heading(layouts.FLUID_FRICTION)
                yield self._line(layouts.FLUID_FRICTION, {"fluid_friction": c.fluid_friction}, "friction")

    def _materials(self) -> Iterator[str]:
        for m in self.materials:
            what, law = f"material {m.id}", layouts.LAWS[m.law]
            eos = self.model.equations_of_state[m.eos] if m.eos is not None else None
            yield from self._heading(layouts.MATERIAL, what)
            yield self._line(
                layouts.MATERIAL,
                {"number": m.id, "model": law.model, "density": m.density,
                 "eos": 0 if eos is None else layouts.EQUATIONS_OF_STATE[eos.law].number,
                 "quadratic": m.viscosity_quadratic, "linear": m.viscosity_linear}, what,
            )  # fmt: skip
            yield from self._heading(layouts.MATERIAL_PARTICLES)
            yield self._line(
                layouts.MATERIAL_PARTICLES, {"mass": m.mass, "h": m.h, "rho_min": m.rho_min, "rho_max": m.rho_max}, what
            )
            yield from self._heading(layouts.MATERIAL_TITLE)
            name = self._text.ascii(m.name, 72, f"name of material {m.id}")
            yield " " + name if name[:1] in ("*", "$") else name
            yield f"$ {layouts.PROPERTY_CARDS} cards, (card, value): {_positions(m.law)}"[:80]
            for row in property_values(m, self.report):
                yield self._line(
                    layouts.PROPERTIES, dict(zip(layouts.PROPERTIES.fields, row.tolist(), strict=True)), what
                )
            if eos is not None:
                yield f"$ equation of state {eos.law}"
                title = self._text.ascii(eos.name, 72, f"name of the equation of state of {what}")
                yield " " + title if title[:1] in ("*", "$") else title
                for layout, values in eos_rows(eos):
                    yield from self._heading(layout)
                    yield self._line(layout, values, what)

    def _particles(self) -> Iterator[bytes]:
        p, dimension = self.particles, self.control.dimension
        self.report.drop(
            "coordinates",
            int(np.count_nonzero(p.x[:, dimension:])),
            f"a {dimension}-dimensional deck has no place for them",
        )
        line = "%8d%5d" + "%20s" * dimension + "%7d\n"
        for start in range(0, len(p), _CHUNK):
            part = slice(start, start + _CHUNK)
            columns = [self._text.texts(p.x[part, axis], 20, "particle coordinates") for axis in range(dimension)]
            bc, material = p.bc[part].tolist(), p.material[part].tolist()
            numbers = range(start + 1, start + 1 + len(bc))
            yield "".join(map(line.__mod__, zip(numbers, bc, *columns, material, strict=True))).encode("ascii")

    def _extra(self) -> Iterator[bytes]:
        p = self.particles
        if p.mass is None and p.h is None and p.rho is None:
            return
        yield _joined(self._heading(layouts.EXTRA))
        columns_of = (("mass", p.mass, 20), ("smoothing length", p.h, 20), ("density", p.rho, 20), ("energy", p.e, 12))
        for start in range(0, len(p), _CHUNK):
            stop = min(start + _CHUNK, len(p))
            columns = [
                ["0.0"] * (stop - start)
                if values is None
                else self._text.texts(values[start:stop], width, f"particle {name}")
                for name, values, width in columns_of
            ]
            yield "".join(
                map("%8d%20s%20s%20s%12s\n".__mod__, zip(range(start + 1, stop + 1), *columns, strict=True))
            ).encode("ascii")

    def _history(self) -> Iterator[str]:
        c = self.control
        if c.history_particles:
            yield "$ history particles"
            for start in range(0, len(c.history_particles), 10):
                yield "".join(f"{number:8d}" for number in c.history_particles[start : start + 10])
        if c.transducers:
            layout = layouts.transducer(c.dimension)
            yield from self._heading(layout, "transducers")
            for row in c.transducers:
                yield self._line(
                    layout, dict(zip(layout.fields, (*row[:-1], int(row[-1])), strict=True)), "transducers"
                )

    def _velocities(self) -> Iterator[str]:
        """The ends of each run of equal velocities: MCM fills the gap between two equal cards."""
        count, overrun = len(self.particles), self.model.velocity_overrun
        velocity = self.particles.velocity
        if velocity is None:
            if not overrun:
                return
            velocity = np.zeros((count, 3))
        yield from self._heading(layouts.VELOCITY)
        changes = (velocity[1:] != velocity[:-1]).any(axis=1)
        ends = np.ones(count, bool)
        ends[1:-1] = changes[1:] | changes[:-1]
        numbers: Ints = np.flatnonzero(ends) + 1
        columns = [self._text.texts(velocity[numbers - 1, axis], 10, "initial velocities") for axis in range(3)]
        yield from map("%8d%10s%10s%10s".__mod__, zip(numbers.tolist(), *columns, strict=True))
        for number in sorted({count + 1, count + overrun} if overrun else ()):
            yield self._line(layouts.VELOCITY, {"number": number}, "velocities")

    def _after(self) -> Iterator[str]:
        c = self.control
        if c.planes is not None:
            names = list(layouts.PLANE_FLAGS.fields)
            yield from self._heading(layouts.PLANE_FLAGS, "boundary planes, codes and positions")
            flags, positions = zip(*c.planes, strict=True)
            yield self._line(layouts.PLANE_FLAGS, dict(zip(names, flags, strict=True)), "boundary planes")
            yield self._line(layouts.PLANE_POSITIONS, dict(zip(names, positions, strict=True)), "boundary planes")
        if c.contact:
            yield from self._heading(layouts.CONTACT, "contact")
            yield self._line(layouts.CONTACT, {"materials": -1, "option": c.contact_option}, "contact")
            yield from self._heading(layouts.CONTACT_LAW, "a card each material")
            for strength, exponent in c.contact_laws:
                yield self._line(layouts.CONTACT_LAW, {"K": strength, "n": exponent}, "contact laws")
        else:
            self.report.drop("contact laws", len(c.contact_laws), "contact 0 (kernel contact) has none")
        if c.base_acceleration is not None and any(c.base_acceleration):
            yield from self._heading(layouts.BASE_ACCELERATION)
            yield self._line(
                layouts.BASE_ACCELERATION,
                dict(zip(("ax", "ay", "az"), c.base_acceleration, strict=True)),
                "base acceleration",
            )

        if c.birth_death and self.dialect == layouts.DIALECTS[-1]:
            yield from self._heading(layouts.BIRTH_RANGE, "birth and death")
            yield self._line(
                layouts.BIRTH_RANGE, dict(zip(("first", "last"), c.birth_range or (0, 0), strict=True)), ""
            )
            for plane in (c.birth_plane if c.plane_particle else None, c.death_plane if c.birth_death >= 2 else None):
                if plane is not None:
                    values = dict(zip(layouts.BIRTH_DEATH_PLANE.fields, plane, strict=True))
                    yield self._line(layouts.BIRTH_DEATH_PLANE, values, "birth and death")


def _positions(law: str) -> str:
    """Where the parameters stand, for the heading of the property cards."""
    return " ".join(f"{name} {card},{value}" for name, (card, value) in layouts.LAWS[law].positions.items())


def _joined(lines: list[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode("ascii")
