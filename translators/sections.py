"""What a part's section says, with the settings over it."""

from __future__ import annotations

from zrno.translators.materials import settings_of
from zrno.translators.model import Model
from zrno.translators.settings import Settings

_CORNERS = ("thickness_1", "thickness_2", "thickness_3", "thickness_4")


def thickness_of(model: Model, part: int, settings: Settings) -> float:
    """Thickness of a part's shells: the settings', else its section's (the mean where its corners differ).

    Raises InputError, placed in the settings, where neither says it.
    """
    name, entry = settings_of(settings, model, part)
    if entry is not None and entry["thickness"] is not None:
        return float(entry["thickness"])
    section = model.sections.get(model.parts[part].section or 0)
    parameters = {} if section is None else section.parameters
    corners = [parameters[key] for key in _CORNERS if parameters.get(key)]
    thickness = parameters.get("thickness") or (sum(corners) / len(corners) if corners else 0.0)
    if not thickness > 0:
        settings.fault(("materials", name), f"the shells of part {name} have no thickness", name,
                       f"materials: {{{name}: {{thickness: ...}}}}")  # fmt: skip
        settings.stop()
    return float(thickness)
