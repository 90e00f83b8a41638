"""What a study states about its files: it fills what they leave open, and does not change what they say."""

from collections.abc import Sequence
from dataclasses import replace

from rockbatch.motions.component import Component
from rockbatch.motions.formats import ReadOptions
from rockbatch.motions.formats.stated_step import SAME_STEP
from rockbatch.units import acceleration_factor

_SAME_UNIT = 1e-9  # relative


def contradictions(components: Sequence[Component], options: ReadOptions, gravity: float) -> list[str]:
    """Where the unit or the step of a file is not the one that is stated, in words; a manifest's are for this very file.

    ``components`` are those of one file, as it was read with ``options``; ``gravity`` [m/s²].
    """
    wrong: list[tuple[str, str, str]] = []
    for component in components:
        if options.unit is not None and "unit" not in options.instead and component.unit:
            said, stated = (acceleration_factor(unit, gravity) for unit in (component.unit, options.unit))
            if abs(said - stated) > _SAME_UNIT * said:
                wrong.append(("unit", component.unit, f'"{options.unit}"'))
        dt = component.dt if options.dt is None or "dt" in options.instead else options.dt
        if abs(dt - component.dt) > SAME_STEP * dt:
            wrong.append(("dt", f"{component.dt:g} s", f"{dt:g}"))
    return [
        f"the file says {said}, but {key} = {stated} is stated for files that do not say: leave it out, and write {key} "
        "in motions.toml for those that need it"
        for key, said, stated in dict.fromkeys(wrong)
    ]


def directed(component: Component, role: str | None) -> Component:
    """``component`` with the ``role`` that is stated for all those of unknown direction: "horizontal"."""
    if component.orientation.known or role is None:
        return component
    note = f"direction not known: {role}, as stated"
    return replace(component, orientation=replace(component.orientation, known=True), notes=(*component.notes, note))
