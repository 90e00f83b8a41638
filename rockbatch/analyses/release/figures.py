"""The figure of a release test: the computed rotation, with the measured impacts and amplitudes on it."""

import numpy as np

from rockbatch.common.analyses import Entry
from rockbatch.common.figures.description import Axis, Figure, Look, Panel, Points, Polyline, line_of
from rockbatch.common.lazy import pd
from rockbatch.reporting.finished_analysis import named

MEASURED = Look("", 2)


def rotations(impacts: "pd.DataFrame", history: "pd.DataFrame", info: Entry) -> Figure:
    """Return a figure with a panel for each case, from release_impacts.csv, release_history.csv and release.json."""
    keys = ["case", *info["varied"]]
    computed = {names: part for names, part in history.groupby(keys, sort=False, dropna=False)}
    groups = impacts.groupby(keys, sort=False, dropna=False)
    panels = []
    for names, measured in groups:
        caption = named(info, dict(zip(keys, names, strict=True)), keys)
        panels.append(_panel(measured, computed[names], caption))
    return Figure(panels, "Rotation after the release, computed and measured")


def _panel(impacts: "pd.DataFrame", history: "pd.DataFrame", caption: str) -> Panel:
    t, theta = history["t_s"].to_numpy(float), history["theta_rad"].to_numpy(float)
    t_amplitude, t_impact = impacts["t_amplitude_computed_s"].to_numpy(float), impacts["t_measured_s"].to_numpy(float)
    amplitude = impacts["amplitude_measured_rad"].to_numpy(float)
    most = 1.08 * max(float(np.abs(theta).max()), float(np.nan_to_num(amplitude).max()))
    t_impact = t_impact[(t[0] <= t_impact) & (t_impact <= t[-1])]
    of_impacts, of_amplitudes = (
        [f"impact at {x:.4g} s" for x in t_impact],
        [f"amplitude {a:.4g} rad" for a in amplitude],
    )
    marks = [
        Polyline(t, theta, look=line_of(0), label="computed"),
        Points(
            t_impact,
            np.zeros(len(t_impact)),
            None,
            of_impacts,
            look=Look("", 2, shape="diamond"),
            label="measured impact",
        ),
        Points(
            t_amplitude,
            np.copysign(amplitude, np.interp(t_amplitude, t, theta)),
            None,
            of_amplitudes,
            look=MEASURED,
            label="measured amplitude",
        ),
    ]
    axes = Axis("t [s]", float(t[0]), float(t[-1]), about=8), Axis("θ [rad]", -most, most, about=6)
    return Panel(*axes, marks, caption, width=420.0, height=172.0)
