"""The sections of an .mcm deck that stand after the particles, each there only if the control cards ask for it."""

from __future__ import annotations

import numpy as np

from zrno.translators.mcm import cards as layouts
from zrno.translators.model import Model, ParticleControl, Particles
from zrno.translators.text import Card, Cards

_PER_CARD = 10  # history particles a card
DEATH = 2  # of birth_death: particles die; 3: and are born


class Sections:
    """Reads the sections in their order, into the model and its control."""

    def __init__(self, cards: Cards, model: Model, control: ParticleControl, paired: bool) -> None:
        self.cards = cards
        self.model = model
        self.control = control
        self.paired = paired

    def history(self, particles: int, transducers: int) -> None:
        """History particles and pressure transducers."""
        assert self.model.particles is not None
        count = len(self.model.particles)
        full = self.cards.block(layouts.HISTORY, -(-particles // _PER_CARD), "history particle card")
        for k in range(particles):
            row, name = k // _PER_CARD, f"id_{k % _PER_CARD + 1}"
            number = int(full[name][row])
            if not 1 <= number <= count:
                full.fault(row, name, "history particle out of range", f"1 to {count}")
            self.control.history_particles.append(number)
        dimension, materials = self.control.dimension, len(self.model.materials)
        block = self.cards.block(layouts.transducer(dimension), transducers, "transducer card")
        inside = (block["material"] >= 1) & (block["material"] <= materials)
        block.check("material", inside, "material number out of range", f"1 to {materials}")
        columns = [block[name].tolist() for name in (*"xyz"[:dimension], "material")]
        self.control.transducers.extend(zip(*columns, strict=True))

    def velocities(self, particles: Particles, after: int) -> None:
        """Velocity cards: the first is particle 1's, a gap is filled where the card after it has the same velocity.

        The section has no length of its own: it is the run of increasing particle numbers, and a coupled deck's
        runs past the last particle. after: how many cards the control cards ask for behind it; one of them may begin
        with what looks like the next particle number (an acceleration of 12 digits).
        """
        count, cards = len(particles), self.cards
        number = layouts.VELOCITY.fields["number"]
        run = max(cards.increasing_run(number), 1)
        short = min(run, cards.left - after)
        if 0 < short < run and cards.peek(layouts.VELOCITY, short)["number"][-1] >= count:
            run = short
        block = cards.block(layouts.VELOCITY, run, "velocity card")
        ids = block["number"]
        velocity = np.column_stack([block["vx"], block["vy"], block["vz"]])
        velocity[:, self.control.dimension :] = 0.0
        if ids[0] != 1:
            block.fault(0, "number", "the velocity cards do not begin with particle 1", "1")
            if ids[-1] < count:
                cards.faults.stop()  # where the section ends is not known
            return
        past = np.flatnonzero(ids > count)
        if len(past) and not self.paired:
            for i in past.tolist()[:5]:
                block.fault(
                    i,
                    "number",
                    f"velocity card past the last particle {count}",
                    f"at most {count}; a coupled deck's may run on over its nodes: run it with its FEM deck",
                )
        last = int(ids[-1])
        if last < count:
            following = cards.card(layouts.VELOCITY, f"the velocity cards up to particle {count}")
            following.fault("number", "velocity card out of order", f"a particle number from {last + 1} to {count}")
            cards.faults.stop()  # where the section ends is not known
        jump = np.flatnonzero((np.diff(ids) > 1) & (velocity[1:] != velocity[:-1]).any(axis=1)) + 1
        for i in jump[:20].tolist():
            block.fault(
                i,
                "number",
                f"the particles from {ids[i - 1] + 1} to {ids[i] - 1} have no velocity",
                "the velocity of the card before, which fills the gap",
            )
        which = np.searchsorted(ids, np.arange(1, count + 1))  # the card at or after each particle
        particles.velocity = velocity[which]
        if last > count:
            self.model.velocity_overrun = last - count
            if velocity[past].any():
                self.model.warnings.append(
                    f"{cards.faults.path}:{block.line(int(past[0]))}: velocities past particle {count} are not used"
                )

    def planes(self, version: int) -> None:
        """Boundary planes: six codes (0 none, 1 symmetry, 2 periodic, 3 limit) and positions."""
        names = list(layouts.PLANE_FLAGS.fields)
        if version == 1:
            positions = self.cards.card(layouts.PLANE_POSITIONS, "the positions of the boundary planes")
            codes = self.cards.card(layouts.PLANE_CODES_VERSION_1, "the codes of the boundary planes")
            active = 2 * self.control.dimension
            flags = [int(codes[name] == 0 and i < active) for i, name in enumerate(names)]
        else:
            codes = self.cards.card(layouts.PLANE_FLAGS, "the codes of the boundary planes")
            positions = self.cards.card(layouts.PLANE_POSITIONS, "the positions of the boundary planes")
            flags = [codes[name] for name in names]
            for name in names:
                codes.check(name, codes[name] in (0, 1, 2, 3), "no such boundary plane", "0, 1, 2 or 3")
            for low, high in zip(names[::2], names[1::2], strict=True):
                if (codes[low] == 2) != (codes[high] == 2):
                    codes.fault(low if codes[low] != 2 else high, "periodic on one side alone", "2 on both sides")
        self.control.planes = [(flag, positions[name]) for flag, name in zip(flags, names, strict=True)]

    def contact(self) -> None:
        """The repulsive contact: K and n of each material."""
        first = self.cards.card(layouts.CONTACT, "the contact card")
        first.check("materials", first["materials"] == -1, "contact of chosen materials is not implemented", "-1 (all)")
        self.control.contact_option = first["option"]
        count = len(self.model.materials)
        laws = self.cards.block(layouts.CONTACT_LAW, count, "contact law of material")
        for i in range(count):
            for name in ("K", "n"):
                text = laws.text(name, i)
                if text and "." not in text:
                    self.model.warnings.append(
                        f"{self.cards.faults.path}:{laws.line(i)}: {name} = {text} has no decimal point: MCM reads it "
                        f"as {laws[name][i]:g} (format e10.5)"
                    )
        self.control.contact_laws = list(zip(laws["K"].tolist(), laws["n"].tolist(), strict=True))

    def base_acceleration(self, flags: list[int], options: Card) -> None:
        """Base acceleration: one card if any direction's flag is on; only flagged directions count."""
        for axis, flag in zip("xyz", flags, strict=True):
            options.check(f"nthp{axis}", flag in (0, 1), "no such base acceleration flag", "0 or 1")
        if not any(flags):
            return
        card = self.cards.card(layouts.BASE_ACCELERATION, "the base acceleration card")
        ax, ay, az = (card[f"a{axis}"] if flag else 0.0 for axis, flag in zip("xyz", flags, strict=True))
        for axis, flag in zip("xyz", flags, strict=True):
            if not flag and card[f"a{axis}"]:
                self.model.warnings.append(
                    f"{self.cards.faults.path}:{card.line}: base acceleration in {axis} is not used: its flag is off"
                )
        if ax or ay or az:
            self.control.base_acceleration = (ax, ay, az)

    def birth_and_death(self) -> None:
        """Particles that are born, the plane where, and the plane where particles die (dialect 2019-10)."""
        c = self.control
        if not c.birth_death:
            return
        born = self.cards.card(layouts.BIRTH_RANGE, "the birth and death card")
        c.birth_range = (born["first"], born["last"])
        born.check("first", 0 <= born["first"] <= born["last"], "particles that are born", "first and last number")

        def plane(what: str) -> tuple[float, float, float, int]:
            card = self.cards.card(layouts.BIRTH_DEATH_PLANE, what)
            return card["x"], card["y"], card["z"], card["orientation"]

        if c.plane_particle > 0:
            c.birth_plane = plane("the plane of birth")
        if c.birth_death >= DEATH:
            c.death_plane = plane("the plane of death")
