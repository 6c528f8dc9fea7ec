"""Reader of .mcm decks: versions 1 and 2, dialects 2.07, 2019-08 and 2019-10, told apart by control card 7."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from zrno.translators.mcm import cards as layouts
from zrno.translators.mcm.laws import read_eos, read_law
from zrno.translators.mcm.sections import DEATH, Sections
from zrno.translators.model import Material, Model, ParticleControl, Particles, Source
from zrno.translators.text import Card, Cards, Fault, InputError, read_bytes

# What decides which cards follow, right after the control cards and after the particles.
AXISYMMETRIC = 4  # of axopt
_DECIDE_MATERIALS = ("axopt", "nummat", "np", "contact_option")
_DECIDE_SECTIONS = (
    "thnode", "transducers", "init_v", "massopt", "init_h", "init_rhoe", "contact", "symmetry", "nthpx", "nthpy",
    "nthpz",
)  # fmt: skip


def read(path: Path | str, *, paired: bool = False) -> Model:
    """Read a deck.

    paired: the deck belongs to a coupled run. Its velocity cards may then run past its particles
    (`Model.velocity_overrun` tells how far) and its last material, the structure's, may own no particle.
    Raises InputError with every fault, up to 20.
    """
    data = read_bytes(path)
    if b"\0" in data:
        raise InputError([Fault(str(path), 1, 1, "a binary file", expected="a text deck (.mcm)")])
    cards = Cards(path, data, comments=b"*$")
    title = cards.card(layouts.TITLE, "the title card")
    version = title["version"]
    if version not in (1, 2):
        said, expected = title.text("version") or "blank", "version 1 or 2 in columns 79-80 of the title"
        raise InputError(
            [Fault(str(path), *title.place("version"), "not an .mcm deck that can be read", said, expected)]
        )
    deck = _Deck(path, cards, version, paired)
    deck.model.title = title.text("title")
    return deck.read()


class _Deck:
    """One deck being read: what the control cards said decides which cards follow."""

    def __init__(self, path: Path | str, cards: Cards, version: int, paired: bool) -> None:
        self.path = str(path)
        self.cards = cards
        self.version = version
        self.paired = paired
        self.control = ParticleControl()
        self.control_cards: list[Card] = []
        self.model = Model(format="mcm", version=str(version), particle_control=self.control)

    def read(self) -> Model:
        control = self._control_cards()
        first, options, interpolation = control["first"], control["options"], control["interpolation"]
        model, dimension = self.model, self.control.dimension
        model.dimension = dimension
        # What cannot be read may be asked for: a material that leaves it to its particles is then not a second fault.
        extra: dict[str, bool] = {
            name: bool(control[name][name]) or not control[name].sound(name)
            for name in ("massopt", "init_h", "init_rhoe")
            if name in control
        }
        for _ in range(first["nummat"]):
            self._material(per_particle_mass=extra["massopt"], per_particle_h=extra["init_h"])
        particles = self._particles(first["np"])
        model.particles = particles
        self._stop_unless_sound(_DECIDE_SECTIONS)
        if any(extra.values()):
            self._extra(particles, extra)
        sections = Sections(self.cards, model, self.control, self.paired)
        sections.history(control["history"]["thnode"], control["history"]["transducers"])
        flags = [options[f"nthp{axis}"] for axis in "xyz"] if self.version == 2 else [0, 0, 0]
        contact = self.version == 2 and bool(options["contact"])
        if self.version == 1 or control["init_v"]["init_v"]:
            born = self.control.birth_death
            last = born and 1 + (self.control.plane_particle > 0) + (born >= DEATH)
            after = 2 * bool(options["symmetry"]) + contact * (1 + first["nummat"]) + any(flags) + last
            sections.velocities(particles, after)
        if options["symmetry"]:
            sections.planes(self.version)
        if contact:
            sections.contact()
        if self.version == 2:
            sections.base_acceleration(flags, options)
            sections.birth_and_death()
        interpolation.check("kernel", interpolation["kernel"] in (0, 1), "no such kernel", "1 (cubic B-spline)")
        self.cards.faults.stop()
        if self.cards.left:
            model.warnings.append(
                f"{self.path}:{self.cards.next_line}: {self.cards.left} cards left over: no control card asks for them"
            )
        return model

    def _control_cards(self) -> dict[str, Card]:
        """Control cards, by what they say; the version decides which card that is."""
        where = {
            2: {"first": 0, "time": 1, "history": 2, "keep": 3, "init_v": 3, "massopt": 3, "init_h": 3, "init_rhoe": 3,
                "options": 4, "interpolation": 5, "h_opt": 5},
            1: {"first": 0, "time": 1, "history": 2, "interpolation": 3, "init_h": 3, "massopt": 4, "options": 4,
                "h_opt": 4},
        }[self.version]  # fmt: skip
        rows = layouts.CONTROL if self.version == 2 else layouts.CONTROL_VERSION_1
        read = [self.cards.card(row, f"control card {i}") for i, row in enumerate(rows, 1)]
        card = {name: read[i] for name, i in where.items()}
        self.control_cards += read
        if self.version == 2:
            self._card_7()
        first, time, history, options = card["first"], card["time"], card["history"], card["options"]
        interpolation = card["interpolation"]
        self._check_control(first, time, history, options, card["h_opt"])
        c = self.control
        c.axisymmetric = first["axopt"] == AXISYMMETRIC
        c.dimension = 2 if c.axisymmetric else first["axopt"]
        if c.axisymmetric:
            self.model.warnings.append(
                "axopt 4, axisymmetric, is taken as x the radius, y the axis; MCM itself refuses it"
            )
        c.discretisation = first["disctype"] if self.version == 2 else {0: 0, 3: 2, 5: 1}.get(first["disctype"], 0)
        c.end_time, c.step_factor, c.initial_step = time["endtime"], time["tssf"], time["itss"]
        c.output_interval, c.state_option = history["stpltime"], history["state_opt"]
        c.history_interval = history["thpltime"]
        c.contact, c.step_option, c.velocity_option = options["contact"], options["tcrit"], options["veloc_opt"]
        c.h_option, c.max_neighbours = card["h_opt"]["h_opt"], interpolation["maxnbr"]
        if self.version == 2:
            c.max_particles = first["max_np"] if first["max_np"] > first["np"] else 0
            c.dynamic_relaxation = time["drelax"]
            c.status_interval, c.restart_interval = history["status"], history["restart"]
            c.run_restart = history["run_restart"]
            c.keep_files = card["keep"]["keep_files"]
        where_asked = {
            "discretisation": (first, "disctype"), "h_option": (card["h_opt"], "h_opt"),
            "kernel": (interpolation, "kernel"), "velocity_option": (options, "veloc_opt"),
            "planes": (options, "symmetry"), "dynamic_relaxation": (time, "drelax"),
        }  # fmt: skip
        c.places |= {field: at.place(name) for field, (at, name) in where_asked.items() if name in at.block.values}
        return card

    def _check_control(self, first: Card, time: Card, history: Card, options: Card, h_opt: Card) -> None:
        first.check(
            "axopt", first["axopt"] in (1, 2, 3, AXISYMMETRIC), "no such dimension", "1, 2 (plane strain), 3 or 4"
        )
        allowed = (0, 1, 2) if self.version == 2 else (0, 3, 5)
        first.check("disctype", first["disctype"] in allowed, "no such discretisation", " or ".join(map(str, allowed)))
        first.check("nummat", first["nummat"] > 0, "no materials", "the number of materials, 1 or more")
        first.check("np", first["np"] > 0, "no particles", "the number of particles, 1 or more")
        for name in ("endtime", "tssf", "itss"):
            time.check(name, time[name] >= 0, f"{name} is negative", "0 or more")
        for name in ("stpltime", "thpltime", "thnode", "transducers"):
            history.check(name, history[name] >= 0, f"{name} is negative", "0 or more")
        history.check("state_opt", 0 <= history["state_opt"] <= 4, "no such output format", "0 to 4")
        options.check("contact", options["contact"] in (0, 1), "no such contact", "0 (kernel) or 1 (repulsive force)")
        if self.version == 1:
            options.check("contact", options["contact"] != 1, "version 1 has no contact cards", "0 (kernel contact)")
        options.check("tcrit", options["tcrit"] in (0, 1, 2), "no such time step option", "0, 1 or 2")
        h_opt.check("h_opt", h_opt["h_opt"] in (0, 1, 2), "no such smoothing length option", "0, 1 or 2")
        self._stop_unless_sound(_DECIDE_MATERIALS)

    def _stop_unless_sound(self, names: tuple[str, ...]) -> None:
        """Raise what was found where one of these fields is at fault: nothing after could be read at its place."""
        if not all(card.sound(name) for card in self.control_cards for name in names):
            self.cards.faults.stop()

    def _card_7(self) -> None:
        text = self.cards.peek(layouts.CARD_7_TEXT, 1)
        said = text.text("card_7") if self.cards.left else ""
        c = self.control
        if any(letter in said for letter in ".eEdD"):
            c.dialect = "2019-08"
            friction = self.cards.card(layouts.FRICTION, "control card 7")
            c.friction = (friction["static_friction"], friction["dynamic_friction"])
            c.places["friction"] = friction.place("static_friction")
            return
        options = self.cards.card(layouts.CARD_7_OPTIONS, "control card 7")
        self.control_cards.append(options)
        if not said:
            return
        c.dialect = "2019-10"
        options.check("birth_death", 0 <= options["birth_death"] <= 3, "no such birth and death", "0 to 3")
        options.check("plane_particle", options["plane_particle"] >= 0, "plane_particle is negative", "0 or more")
        c.birth_death, c.plane_particle = options["birth_death"], options["plane_particle"]
        c.places["birth_death"] = options.place("birth_death")
        kind = options["contact_option"]
        c.places |= dict.fromkeys(("friction", "fluid_friction"), options.place("contact_option"))
        options.check(
            "contact_option", kind in (0, 1, 2), "no such contact option", "0, 1 (friction) or 2 (fluid friction)"
        )
        if kind == 1:
            friction = self.cards.card(layouts.FRICTION, "the friction card")
            # a blank field is MCM's default
            static = friction["static_friction"] if friction.text("static_friction") else 0.5
            dynamic = friction["dynamic_friction"] if friction.text("dynamic_friction") else 0.02
            c.friction = (static, dynamic)
        elif kind == 2:
            c.fluid_friction = self.cards.card(layouts.FLUID_FRICTION, "the fluid friction card")["fluid_friction"]

    def _material(self, *, per_particle_mass: bool, per_particle_h: bool) -> None:
        number = len(self.model.materials) + 1
        a = self.cards.card(layouts.MATERIAL, f"material {number}")
        a.check("number", a["number"] == number, "material number out of order", str(number))
        b = self.cards.card(layouts.MATERIAL_PARTICLES, f"mass and smoothing length of material {number}")
        a.check("density", a["density"] > 0, "density is not positive", "a positive density")
        b.check("mass", per_particle_mass or b["mass"] > 0, "mass is not positive", "the total mass of the material")
        b.check("h", per_particle_h or b["h"] > 0, "smoothing length is not positive", "a positive length")
        a.check("visc_type", a["visc_type"] in (0, 1), "no such viscosity", "0 or 1")
        title = self.cards.card(layouts.MATERIAL_TITLE, f"title of material {number}")
        properties = self.cards.block(layouts.PROPERTIES, layouts.PROPERTY_CARDS, f"property card of material {number}")
        material = Material(
            number,
            title.text("material_title"),
            density=a["density"],
            mass=b["mass"],
            h=b["h"],
            rho_min=b["rho_min"] or None,
            rho_max=b["rho_max"] or None,
            viscosity_quadratic=a["quadratic"] or None,
            viscosity_linear=a["linear"] or None,
            source=Source(self.path, a.line),
        )
        self.model.materials[number] = material
        if not a.sound("eos"):
            self.cards.faults.stop()  # cards of an equation of state may follow, or none
        law = next((name for name, row in layouts.LAWS.items() if row.model == a["model"]), None)
        if law is None:
            supported = ", ".join(f"{row.model} ({name})" for name, row in layouts.LAWS.items())
            a.fault("model", "no such material model", f"one of {supported}")
        else:
            read_law(self.model, material, law, properties)
        needs = law is not None and layouts.LAWS[law].eos
        numbers = ", ".join(f"{row.number} ({name})" for name, row in layouts.EQUATIONS_OF_STATE.items())
        if law is not None:
            message = f"the {law} law {'needs an' if needs else 'takes no'} equation of state"
            a.check("eos", (a["eos"] != 0) == needs, message, f"one of {numbers}" if needs else "0")
        if a["eos"]:
            kind = next((n for n, row in layouts.EQUATIONS_OF_STATE.items() if row.number == a["eos"]), None)
            if kind is None:
                a.fault("eos", "no such equation of state", f"one of {numbers}")
                self.cards.faults.stop()  # how many cards it has is not known
            else:
                self.model.equations_of_state[number] = read_eos(self.cards, kind, number)
                material.eos = number

    def _particles(self, count: int) -> Particles:
        dimension = self.control.dimension
        block = self.cards.block(layouts.particle(dimension), count, "particle card")
        numbers = np.arange(1, count + 1)
        if not (block["number"] == numbers).all():
            wrong = int(np.flatnonzero(block["number"] != numbers)[0])  # all after it are shifted: say it once
            block.fault(wrong, "number", "particle number out of order", str(wrong + 1))
        block.check("bc", (block["bc"] >= 0) & (block["bc"] <= 7), "no such boundary code", "0 to 7")
        materials = len(self.model.materials)
        inside = (block["material"] >= 1) & (block["material"] <= materials)
        block.check("material", inside, "material number out of range", f"1 to {materials}")
        x = np.zeros((count, 3))
        for axis, name in enumerate("xyz"[:dimension]):
            x[:, axis] = block[name]
        owned = np.bincount(block["material"][inside], minlength=materials + 1)[1:]
        for i in np.flatnonzero(owned == 0).tolist():
            if not (self.paired and i == materials - 1) and inside.all():
                source = self.model.materials[i + 1].source
                assert source is not None
                hint = (
                    "; the last one may belong to a structure: run the deck with its FEM deck"
                    if i == materials - 1
                    else ""
                )
                self.cards.faults.add(
                    source.line, 1, f"material {i + 1} owns no particle", expected=f"particles of it{hint}"
                )
        return Particles(x, block["material"], block["bc"])

    def _extra(self, particles: Particles, extra: dict[str, bool]) -> None:
        count = len(particles)
        if self.cards.left and self.cards.peek(layouts.PAST_LINE, 1).text("past"):
            place = f"{self.path}:{self.cards.next_line}"
            self.model.warnings.append(f"{place}: text past column 80 (the energy's last 8 columns) is not read")
        block = self.cards.block(layouts.EXTRA, count, "mass, smoothing length, density and energy card")
        block.check(
            "number", block["number"] == np.arange(1, count + 1), "particle number out of order", "1, 2, 3, ..."
        )
        if extra["massopt"]:
            block.check("mass", block["mass"] > 0, "mass is not positive", "the particle's mass")
            particles.mass = block["mass"]
        if extra["init_h"]:
            block.check("h", block["h"] > 0, "smoothing length is not positive", "a positive length")
            particles.h = block["h"]
        if extra.get("init_rhoe"):
            block.check("rho", block["rho"] > 0, "density is not positive", "a positive density")
            particles.rho, particles.e = block["rho"], block["e"]
