"""The velocity and displacement that a file tells for its first sample, on its way to PGV and PGD."""

import re
from dataclasses import replace

import numpy as np
import pytest
from agency_files import geonet_component
from fixed_column_files import NPTS, A, cosmos_header, cosmos_series, csmip_channel, read
from motion_files import RECORDS, needs_records

from rockbatch.batch.digests import digests
from rockbatch.motions import Motion, read_motions
from rockbatch.motions.component import Component
from rockbatch.motions.formats import RecordFile, read_record
from rockbatch.motions.identity.pairing import to_motions
from rockbatch.motions.intensity import measures
from rockbatch.motions.labels.orientation import Orientation
from rockbatch.motions.motion import Initial
from rockbatch.motions.motion_set import MotionSet
from rockbatch.motions.suites.scaling import Target, at_target
from rockbatch.motions.suites.selection import Selection, selected

DT = 0.005
BEGINS = Initial(0.12, -0.03)
V, D = (100 * series(A / 100, DT, BEGINS) for series in (measures.velocity, measures.displacement))  # cm/s, cm


def shaking(seed: int = 1, npts: int = 400) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=npts)


def of_cosmos(text: str):
    (component,) = read(text, "x.V2")
    return component.initial


def test_cosmos_begins_with_the_series_beside_whichever_header_they_have():
    head = cosmos_header("Corrected acceleration", A, "90 Deg")
    velocities = cosmos_series("velocity", V, unit="cm/sec(05)", layout="1E15.6")
    displacements = cosmos_series("displacement", D, unit="cm(06)", layout="1E15.6")
    own = cosmos_header("Corrected velocity", V, "90 Deg", unit_code=5)
    accelerations = cosmos_series("acceleration", A)
    for lines in (
        [*head, *accelerations, *velocities, *displacements],
        [*head, *accelerations, *own, *velocities, *own, *displacements],
    ):
        found = of_cosmos("\n".join([*lines, ""]))
        assert (found.velocity, found.displacement) == pytest.approx((0.12, -0.03), abs=1e-6)
    elsewhere = cosmos_header("Corrected velocity", V, "90 Deg", location="Elsewhere")
    assert of_cosmos("\n".join([*head, *accelerations, *elsewhere, *velocities, ""])) is None


def test_of_cosmos_from_real_numbers_68_and_69_where_there_is_no_series():
    def text(stage: str, velocity: float, displacement: float) -> str:
        lines = cosmos_header(f"{stage} acceleration", A, "90 Deg")
        first = next(i for i, line in enumerate(lines) if "Real-header" in line) + 1
        numbers = "".join(lines[first : first + 17])
        fields = [numbers[i : i + 13] for i in range(0, len(numbers), 13)]
        fields[67], fields[68] = f"{velocity:13.6f}", f"{displacement:13.6f}"
        lines[first : first + 17] = ["".join(fields[i : i + 6]) for i in range(0, 100, 6)]
        return "\n".join([*lines, *cosmos_series("acceleration", A), ""])

    assert of_cosmos(text("Corrected", 12.0, -3.0)) == BEGINS
    assert of_cosmos(text("Corrected", 12.0, -999.0)) == Initial(0.12, 0.0)
    assert of_cosmos(text("Corrected", -999.0, -3.0)) is None
    assert of_cosmos(text("Uncorrected", 12.0, -3.0)) is None


def csmip_text(velocities=None, displacements=None) -> str:
    """Volume 2 with velocities [cm/s] and displacements [cm] of one's own, and 1.2 cm/s in its header's text."""
    lines = csmip_channel("90 Deg", A, volume=2)
    for word, values in (("veloc", velocities), ("displ", displacements)):
        at = next(i for i, line in enumerate(lines) if re.match(rf" *{NPTS} points of {word} data", line))
        if values is not None:
            rows = -(-NPTS // 8)
            lines[at + 1 : at + 1 + rows] = [
                "".join(f"{value:10.6f}" for value in values[i : i + 8]) for i in range(0, NPTS, 8)
            ]
    lines = [line.replace("=      .000   cm/sec;", "=     1.200   cm/sec;") for line in lines]
    return "\n".join([*lines, ""])


def test_csmip_begins_with_its_velocities_not_with_its_header():
    dt = 0.01
    v, d = (100 * series(A / 100, dt, BEGINS) for series in (measures.velocity, measures.displacement))
    (component,) = read(csmip_text(v, d), "x.V2")
    assert component.initial is not None
    assert (component.initial.velocity, component.initial.displacement) == pytest.approx((0.12, -0.03), abs=1e-6)
    (other,) = read(csmip_text(np.random.default_rng(1).normal(size=NPTS)), "x.V2")
    assert other.initial is None  # velocities that are not of these accelerations


def test_of_geonet_in_mm():
    dt, a = 0.005, np.round(1000 * shaking(2, 43), 1)
    v, d = (1000 * series(a / 1000, dt, BEGINS) for series in (measures.velocity, measures.displacement))
    lines = geonet_component("N28W", a, volume=2, dt=dt)
    rows = -(-43 // 10)
    for k, (values, form) in enumerate(((v, "8.2f"), (d, "8.3f")), start=1):
        fields = [format(value, form) for value in values]
        lines[26 + k * rows : 26 + (k + 1) * rows] = ["".join(fields[i : i + 10]) for i in range(0, 43, 10)]
    lines[14], lines[15] = (
        "Velocity:      peak  -298.49 mm/s   at  59.02 sec",
        "Displacement:  peak   99.407 mm     at  53.60 sec",
    )
    (component,) = read("\n".join([*lines, ""]), "x.V2A")
    assert component.initial is not None
    assert (component.initial.velocity, component.initial.displacement) == pytest.approx((0.12, -0.03), abs=1e-5)
    assert component.processed


# On the way to a motion


def component(values, azimuth=None, start=None, initial=None, dt=0.01) -> Component:
    way = Orientation("UP", vertical=True) if azimuth is None else Orientation(f"{azimuth:g}", azimuth=azimuth)
    return Component(f"c{way.label}", dt, values, way, "S", "/f", (f"{way.label}.x",), start, initial=initial)


def ground(motion: Motion) -> tuple[np.ndarray, np.ndarray]:
    assert motion.initial is not None
    return (
        measures.velocity(motion.horizontal, motion.dt, motion.initial),
        measures.displacement(motion.horizontal, motion.dt, motion.initial),
    )


def test_a_record_that_is_cut_to_its_vertical_moves_on_as_it_did():
    a = shaking()
    whole = measures.velocity(a, 0.01, BEGINS), measures.displacement(a, 0.01, BEGINS)
    horizontal = component(a, 0.0, 100.0, BEGINS)
    for later, samples in ((0.2, slice(20, 320)), (0.0, slice(0, 300))):
        (motion,) = to_motions([horizontal, component(shaking(2, 300), None, 100.0 + later)]).motions
        for found, expected in zip(ground(motion), whole, strict=True):
            np.testing.assert_allclose(found, expected[samples], atol=1e-12)
    (between,) = to_motions([horizontal, component(shaking(2, 800), None, 100.0 + 0.205, dt=0.005)]).motions
    assert between.dt == 0.005
    np.testing.assert_allclose(
        ground(between)[0][1::2][:100], whole[0][21:121], atol=1e-9
    )  # times since 1970 to 1e-7 s


def test_turned_components_begin_as_the_two_of_them_do_together():
    a, b = shaking(1), shaking(2, 380)
    first, second = component(a, 0.0, 100.0, BEGINS), component(b, 90.0, 100.1, Initial(-0.2, 0.01))
    (motion,) = to_motions([first, second], azimuths=(30.0,)).motions
    north, east = (measures.displacement(x, 0.01, c.initial) for x, c in ((a, first), (b, second)))
    expected = np.cos(np.radians(30)) * north[10:390] + np.sin(np.radians(30)) * east
    np.testing.assert_allclose(ground(motion)[1], expected, atol=1e-9)
    (unknown,) = to_motions([first, replace(second, initial=None)], azimuths=(30.0,)).motions
    assert unknown.initial is None


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("scale = 2", Initial(0.24, -0.06)),
        ('polarity = "-"', Initial(-0.12, 0.03)),
        ('unit = "m/s2"', None),
        ("dt = 0.02", None),
    ],
)
def test_a_manifest_changes_it_with_the_accelerations(tmp_path, keys, expected):
    lines = [
        *cosmos_header("Corrected acceleration", A, "90 Deg"),
        *cosmos_series("acceleration", A),
        *cosmos_series("velocity", V, unit="cm/sec(05)", layout="1E15.6"),
        *cosmos_series("displacement", D, unit="cm(06)", layout="1E15.6"),
    ]
    (tmp_path / "x.V2").write_text("\n".join([*lines, ""]), encoding="latin-1")
    (tmp_path / "motions.toml").write_text(f'[[record]]\nfile = "x.V2"\n{keys}\n')
    (motion,) = read_motions(tmp_path, confirmed=["*"]).motions
    if expected is None:
        assert motion.initial is None
    else:
        assert motion.initial is not None
        assert (motion.initial.velocity, motion.initial.displacement) == pytest.approx(
            (expected.velocity, expected.displacement), abs=1e-6
        )


def test_a_target_and_a_selection_go_by_the_velocity_that_there_was():
    t = np.arange(401) * 0.01
    cosine = Motion("m", 0.01, np.sin(2 * np.pi * t), initial=Initial(-1 / (2 * np.pi)))
    assert measures.pgv(cosine.horizontal, 0.01, cosine.initial) == pytest.approx(1 / (2 * np.pi), rel=1e-3)
    (scaled,) = at_target(MotionSet([cosine]), Target(pgv_m_s=0.5), 9.81).motions
    assert scaled.factor == pytest.approx(np.pi, rel=1e-3)
    assert measures.pgv(scaled.horizontal, 0.01, scaled.initial) == pytest.approx(0.5, rel=1e-12)
    assert len(selected(MotionSet([cosine]), Selection(pgv_m_s=(0.1, 0.2)), 9.81).motions) == 1


def test_what_rows_depend_on_has_it_since_levels_of_pgv_do():
    m = Motion("m", 0.01, shaking())
    assert digests([m])["motions"] != digests([replace(m, initial=BEGINS)])["motions"]


# Against the velocities, displacements and header peaks of real files


def stated_peaks(path, unit: float) -> list[tuple[float, float]]:
    text = path.read_text("latin-1")
    peaks = [
        re.findall(rf"(?i)peak\s+{word}\s*=\s*([-0-9.]+)|{word}:\s+peak\s+([-0-9.]+)", text)
        for word in ("velocity", "displacement")
    ]
    numbers = [[abs(float(a or b)) * unit for a, b in found] for found in peaks]
    return list(zip(*numbers, strict=True))


@needs_records
@pytest.mark.parametrize("pattern", ["*/*/CHAN*.V2", "*/*/*.V2A"])
def test_peaks_of_corrected_real_records_are_those_of_their_headers(pattern):
    """Within 1.2 % (PGV) and 6 % (PGD) or 1 mm: the agencies integrated before they thinned the samples out."""
    unit = 0.01 if pattern.endswith(".V2") else 0.001
    paths = sorted(RECORDS.glob(pattern))
    assert paths
    for path in paths:
        components = read_record(RecordFile(path, path.name, path.read_bytes()))
        stated = stated_peaks(path, unit)
        assert len(stated) == len(components)
        for c, (velocity, displacement) in zip(components, stated, strict=True):
            assert isinstance(c, Component)
            assert c.initial is not None
            if not c.orientation.vertical:  # in 50 Hz samples a vertical's peaks are cut by up to 6 %
                assert measures.pgv(c.acceleration, c.dt, c.initial) == pytest.approx(velocity, rel=0.012)
            assert measures.pgd(c.acceleration, c.dt, c.initial) == pytest.approx(displacement, rel=0.06, abs=1e-3)


@needs_records
def test_meloland_moved_by_a_third_of_a_metre_and_not_by_one():
    motions = {m.name: m for m in read_motions(RECORDS / "formats" / "imperialvalley79_meloland_ff").motions}
    meloland = motions["CHAN24"]
    assert measures.pgd(meloland.horizontal, meloland.dt) == pytest.approx(1.086, abs=1e-3)  # from rest
    assert measures.believable_pgd(meloland) == pytest.approx(0.3257, abs=1e-3)  # as its header says
    assert meloland.initial is not None
    assert meloland.initial.velocity == pytest.approx(+0.0191, abs=1e-4)  # its header's text has the other sign


@needs_records
def test_mount_wilson_whose_samples_were_thinned_out_does_not_drift():
    (east, north) = read_motions(RECORDS / "formats" / "whittier_mtwilson").motions
    for motion, stated in ((east, 0.00315), (north, 0.00441)):
        assert measures.believable_pgd(motion) == pytest.approx(stated, abs=1.2e-3)
