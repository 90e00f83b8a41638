"""The piers to scale, with the heights at which results are read and the constants of their devices."""

from collections.abc import Collection, Sequence
from typing import NamedTuple

from rockbatch.common.grouping import grouped
from rockbatch.pier.figures import devices, sketches, springs_below
from rockbatch.quantities.cases import Case, top
from rockbatch.quantities.design import of_design
from rockbatch.reporting.finished import Finished
from rockbatch.reporting.labels import first_of
from rockbatch.reporting.markup import Markup, join, tag
from rockbatch.reporting.structure import devices_in_words, names_of, pier_of, restraints_of
from rockbatch.reporting.svg import sketch
from rockbatch.results.labelled import Row, pier_key

MOST_NAMES, MOST_LINES = 4, 6
"""Most names of cases, and lines on devices, of a drawing."""


class Drawing(NamedTuple):
    """A drawing and its cases: those of one pier with devices at the same places, on one support if it is named after them."""

    row: Row
    """The pier as in run.json, with its deck, heights and devices."""
    cases: list[Case]

    @property
    def springs(self) -> int:
        """Return the number of springs on which it is drawn."""
        return springs_below({case["base"] for case in self.cases})

    @property
    def shape(self) -> tuple[object, ...]:
        """Return what the drawing of the pier without devices depends on."""
        return *(self.row.get(key) for key in ("alpha", "p", "highest_m", "top_m")), *self.row["sections_m"]


def drawings(finished: Finished) -> Markup:
    """Return a sketch of each distinct pier with its devices, up to four, captioned with the constants of the devices.

    Of several drawings of one pier only the first has the dimensions, and the devices that all cases have in its caption. Each
    is named after its cases, and stands on their support. Empty if no pier can be drawn.
    """
    rows = [_drawing(finished, case) for case in finished.info["cases"]]
    by_pier = [_distinct(of_pier) for of_pier in grouped(rows, lambda drawing: drawing.shape).values()]
    single = sum(map(len, by_pier)) == 1
    piers = []
    for of_pier in by_pier:
        common = set.intersection(*(set(devices_in_words(case)) for drawing in of_pier for case in drawing.cases))
        for place, drawing in enumerate(of_pier):
            title = "" if single else _title(finished, drawing, len(of_pier) > 1)
            lines = _lines(finished, drawing.cases, common if place else ())
            caption = join(tag("strong", title) if title else "", *(tag("small", line) for line in lines))
            piers.append(drawing.row | {"labels": place == 0, "caption": caption, "springs": drawing.springs})
    drawn = [sketch(figure) for figure in sketches(piers)]
    return tag("div", *drawn, class_="piers") if drawn else Markup("")


def _distinct(of_pier: Sequence[Drawing]) -> list[Drawing]:
    """Return the drawings of one pier that differ: in their devices, and those that do in their supports, too."""
    several = len({drawing.row["devices"] for drawing in of_pier}) > 1
    same = grouped(of_pier, lambda drawing: (drawing.row["devices"], drawing.springs if several else 0)).values()
    return [Drawing(alike[0].row, [case for drawing in alike for case in drawing.cases]) for alike in same]


def _drawing(finished: Finished, case: Case) -> Drawing:
    """Return the drawing of one case."""
    pier = pier_of(case)
    row = case["pier"] | {"top_m": top(case), "sections_m": finished.section_heights(case)}
    if pier and "deck_mass_t" in finished.pier_as_given:
        row["deck_m"] = pier.deck
    return Drawing(row | {"devices": devices(pier, restraints_of(case)) if pier else ()}, [case])


def _title(finished: Finished, drawing: Drawing, several: bool) -> str:
    """Return the varied values of the pier, or the names of the cases; "pier, names" if ``several`` drawings are of it.

    A case has the name of its bound if the drawing is not that of its nominal design. At most :data:`MOST_NAMES` are named.
    """
    case = drawing.cases[0]
    place = finished.pier_places.get(pier_key(case["columns"], finished.info["varied"]))
    pier = "" if place is None else finished.piers[place]
    names = first_of(names_of(drawing.cases), MOST_NAMES)
    return ", ".join(filter(None, (pier, names))) if several or not pier else pier


def _lines(finished: Finished, cases: Sequence[Case], known: Collection[str]) -> list[str]:
    """Return the devices of cases that share a drawing, but ``known`` ones; "B: damper" for a device that only case B has.

    A case under a bound is named only if its device is not that of its design. At most :data:`MOST_LINES`, six, then one
    that says how many more there are.
    """
    firsts: dict[object, list[str]] = {}
    having: dict[str, list[str]] = {}
    for case in cases:
        own = devices_in_words(case)
        of_design_ = firsts.setdefault((case["case"], str(of_design(case["columns"]))), own)
        for words in dict.fromkeys(own):
            if words not in known and (own is of_design_ or words not in of_design_):
                name = finished.named_case(case["case"], case["columns"], finished.info["varied"])
                having.setdefault(words, []).append(name)
    of_all = set.intersection(*map(set, firsts.values()))
    lines = [words if words in of_all else f"{first_of(names, MOST_NAMES)}: {words}" for words, names in having.items()]
    left_out = len(lines) - MOST_LINES
    return lines[:MOST_LINES] + [f"{left_out} more in the table of foundations"] * (left_out > 0)
