"""`--set KEY=VALUE`: what its keys may be, and to which part of a run each belongs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from zrno.pipelines.scene import OF_EVERY_MESH, Scene, option_places
from zrno.translators.model import Model
from zrno.translators.setting_table import TABLE
from zrno.translators.settings import Settings
from zrno.translators.settings import load as load_settings
from zrno.translators.text import Fault, InputError
from zrno.translators.yaml_marks import Place, did_you_mean, parse_value

RUN = {"compat": ("original",)}
SETTINGS = tuple(item.key for item in TABLE)

# Settings that a deck holds as they are: key -> field of the particle control cards.
CONTROL = {
    "end_time": "end_time",
    "step_factor": "step_factor",
    "initial_step": "initial_step",
    "output_interval": "output_interval",
    "history_interval": "history_interval",
    "step_option": "step_option",
    "h_option": "h_option",
}
# Settings that it holds in another form.
_OTHER_CONTROL = {
    "xsph": "velocity_option",
    "gravity": "base_acceleration",
    "friction": "friction",
    "birth_death": "birth_death",
}


@dataclass(slots=True)
class Options:
    """The keys of `--set`, apart. run: the solver's own (`compat`); scene: for `scene.load`; settings: deck fields."""

    run: dict[str, Any] = field(default_factory=dict)
    scene: dict[str, Any] = field(default_factory=dict)
    settings: dict[str, Any] = field(default_factory=dict)


def parse(pairs: Sequence[str]) -> dict[str, Any]:
    """KEY=VALUE texts as values by key, a value as it stands in YAML. Raises InputError."""
    options: dict[str, Any] = {}
    faults = []
    for pair in pairs:
        key, equals, text = pair.partition("=")
        try:
            options[key.strip()] = parse_value(text)
        except ValueError:
            faults.append(Fault("--set", 1, len(key) + 2, f"the value of {key} is not YAML", text, "KEY=VALUE"))
        if not equals or not key.strip():
            faults.append(Fault("--set", 1, 1, "not a key and its value", pair, "KEY=VALUE"))
    if faults:
        raise InputError(faults)
    return options


def split(options: Mapping[str, Any]) -> Options:
    """Sort options by what they belong to: the run, the scene file, or settings of decks. Raises InputError.

    Keys of the scene and of its meshes go to `scene`; settings go to both `scene`, which makes its meshes by them, and
    `settings`, for decks that are there already (`apply`).
    """
    found = Options()
    faults = []
    for key, value in options.items():
        first = key.partition(".")[0]
        if key in RUN:
            found.run[key] = value
            if value not in RUN[key]:
                expected = "one of " + ", ".join(RUN[key])
                faults.append(Fault("--set", 1, len(key) + 2, f"{key} has a wrong value", str(value), expected))
        elif first in Scene.model_fields or first in OF_EVERY_MESH:
            found.scene[key] = value
        elif first in SETTINGS:
            found.scene[key] = found.settings[key] = value
        else:
            known = (*RUN, *Scene.model_fields, *OF_EVERY_MESH, *SETTINGS)
            faults.append(Fault("--set", 1, 1, f"unknown key {key}", key, did_you_mean(first, known)))
    if faults:
        raise InputError(faults)
    return found


def apply(settings: Mapping[str, Any], model: Model) -> dict[str, Place]:
    """Put settings into a deck that was read; returns the places of the control fields that they replaced.

    Raises InputError for those that only a mesh can be made with.
    """
    known = (*CONTROL, "xsph", "gravity", "viscosity.quadratic", "viscosity.linear")
    faults = []
    for key, value in settings.items():
        if key not in known:
            message = f"{key} is for decks that a scene makes from a mesh; this deck is there already"
            faults.append(Fault("--set", 1, len(key) + 2, message, str(value), ", ".join(known)))
    if faults:
        raise InputError(faults)
    values = load_settings(
        None, overrides=settings, places={key: option_places(key, settings[key]) for key in settings}
    )
    control = model.particle_control
    if control is None:  # not a particle deck: said when it is run
        return {}
    for key in settings:
        match key:
            case "xsph":
                control.velocity_option = int(values[key])
            case "gravity":
                control.base_acceleration = values[key] if any(values[key]) else None
            case "viscosity.quadratic" | "viscosity.linear":
                name = key.replace(".", "_")
                for material in model.materials.values():
                    setattr(material, name, values["viscosity"][key.partition(".")[2]])
            case _:
                setattr(control, CONTROL[key], values[key])
    return control_places(values)


def control_places(settings: Settings) -> dict[str, Place]:
    """The places of the values of settings, by the field of the particle control that each became."""
    fields = CONTROL | _OTHER_CONTROL
    return {field: settings.place(key, value=True) for key, field in fields.items() if settings.gives(key)}
