"""Mistakes as engineers make them: an answer that is followed to the letter leads to the study that was meant."""

import re
import tomllib

import pytest
from studies import write_study

from rockbatch.checks.rule_files import load_rules
from rockbatch.common.errors import InputError
from rockbatch.motions.manifest import Manifest
from rockbatch.study import Study, load_study
from rockbatch.toml.slips import meant_line

STUDY = """\
title = "Pier 4"

[pier]
width_m = 4.0
height_m = 30.0
mass_t = 1800.0
deck_mass_t = 900.0
flexural_period_s = 0.6

[motions]
path = "records"
vertical = true
polarity = ["+", "-"]
scale = 1.5
unit = "cm/s2"
dt = 0.01
axis_deg = 35

[motions.target]
pga_g = 0.4

[[motions.pulse]]
name = "pulse"
shape = "sine"
amplitude_g = 0.3
period_s = 1.25
dt_s = 0.004
duration_s = 8.0

[numerics]
tolerance = 1e-3
quiet_s = 4.0

[output]
forces = true

[[case]]
name = "rock"
base = "rigid"
restitution = 0.85
friction = 0.4

[[case]]
name = "pads"
base = "yielding"
stiffness_kN_m = 1.5e6
yield_kN = [3.0e4, 5.0e4]
spring = "epp"
zeta = 0.07

[[case.damper]]
kind = "viscous"
coefficient_kN_s_m = 800.0
exponent = 0.35

[[case.damper]]
kind = "hysteretic"
force_kN = 350.0
yield_mm = 8.0

[[case.tendon]]
prestress_kN = 4000.0
stiffness_kN_m = 30000.0

[[case.stop]]
gap_mm = 120.0
stiffness_kN_m = 4.0e5

[[check]]
name = "rotation"
demand = "theta_max_rad"
statistic = "mean"
at_most = 0.05
basis = "code"
reason = "bearing rotation"

[[check]]
name = "uplift"
demand = "heel_uplift_mm"
at_most = 150
reason = "shear keys"

[[check]]
name = "ratio"
demand = "drift_ratio"
at_most = 0.04
reason = "joints"
"""
REPLACED = [  # what is meant, and what is written instead
    # the pier
    ("mass_t = 1800.0", "mass = 1800.0"),
    ("deck_mass_t = 900.0", "superstructure_mass_t = 900.0"),
    ("width_m = 4.0", "diameter_m = 4.0"),
    ("flexural_period_s = 0.6", "period_s = 0.6"),
    ("[pier]", "[Pier]"),
    ("[pier]", "[geometry]"),
    # the ground
    ("[motions]\n", "[ground_motions]\n"),
    ('path = "records"', 'folder = "records"'),
    ('path = "records"', 'file = "records"'),
    ('path = "records"', 'records = "records"'),
    ('polarity = ["+", "-"]', 'polarity = "both"'),
    ("scale = 1.5", "scale_factor = 1.5"),
    ('unit = "cm/s2"', 'units = "cm/s2"'),
    ("dt = 0.01", "dt_s = 0.01"),
    ("dt = 0.01", "time_step = 0.01"),
    ("axis_deg = 35", "azimuth = 35"),
    ("axis_deg = 35", 'axis_deg = "N35E"'),
    ("pga_g = 0.4", "pga = 0.4"),
    ("[[motions.pulse]]", "[motions.pulse]"),
    ('shape = "sine"', 'type = "sine"'),
    ('shape = "sine"', 'shape = "sinusoidal"'),
    ("amplitude_g = 0.3", "pga_g = 0.3"),
    ("period_s = 1.25", "Tp = 1.25"),
    ("dt_s = 0.004", "dt = 0.004"),
    # numerics and output
    ("[numerics]", "[analysis]"),
    ("tolerance = 1e-3", "rtol = 1e-3"),
    ("quiet_s = 4.0", "free_vibration_s = 4.0"),
    ("forces = true", "force = true"),
    # the cases
    ("[[case]]", "[[cases]]"),
    ('base = "rigid"', 'base = "fixed"'),
    ('base = "rigid"', 'foundation = "rigid"'),
    ('base = "yielding"', 'base = "inelastic"'),
    ("restitution = 0.85", "coefficient_of_restitution = 0.85"),
    ("restitution = 0.85", "cor = 0.85"),
    ("restitution = 0.85", "restitution = 85"),
    ("friction = 0.4", "friction_coefficient = 0.4"),
    ("friction = 0.4", "mu = 0.4"),
    ("stiffness_kN_m = 1.5e6", "k = 1.5e6"),
    ("yield_kN = [3.0e4, 5.0e4]", "Fy_kN = [3.0e4, 5.0e4]"),
    ('spring = "epp"', 'spring = "bilinear"'),
    ('spring = "epp"', 'spring = "elastoplastic"'),
    ('spring = "epp"', 'spring = "EPP"'),
    ('spring = "epp"', 'law = "epp"'),
    ("zeta = 0.07", "damping = 0.07"),
    ("zeta = 0.07", "damping_percent = 7"),
    ("zeta = 0.07", "zeta = 7"),
    # devices
    ('kind = "viscous"', 'kind = "dashpot"'),
    ('kind = "viscous"', 'kind = "fluid viscous"'),
    ('kind = "viscous"', 'type = "viscous"'),
    ('kind = "hysteretic"', 'kind = "steel"'),
    ("coefficient_kN_s_m = 800.0", "C = 800.0"),
    ("exponent = 0.35", "alpha = 0.35"),
    ("force_kN = 350.0", "yield_kN = 350.0"),
    ("yield_mm = 8.0", "yield = 8.0"),
    ("yield_mm = 8.0", "yield_displacement_mm = 8.0"),
    ("prestress_kN = 4000.0", "pretension_kN = 4000.0"),
    # checks
    ("[[check]]", "[[checks]]"),
    ('demand = "theta_max_rad"', 'demand = "rotation"'),
    ('demand = "theta_max_rad"', 'demand = "theta_maximum_rad"'),
    ('demand = "theta_max_rad"', 'demand = "peak rotation"'),
    ('demand = "drift_ratio"', 'demand = "peak_drift_ratio"'),
    ('demand = "drift_ratio"', 'demand = "top_drift_ratio"'),
    ('demand = "theta_max_rad"', 'edp = "theta_max_rad"'),
    ('statistic = "mean"', 'statistic = "average"'),
    ("at_most = 0.05", "limit = 0.05"),
    ("at_most = 0.05", "max = 0.05"),
    ('basis = "code"', 'basis = "standard"'),
    ('reason = "bearing rotation"', 'source = "bearing rotation"'),
    # other names, and lines that are no TOML
    ("mass_t = 1800.0", "pier_mass_t = 1800.0"),
    ("mass_t = 1800.0", "mass_kg = 1800000"),
    ("mass_t = 1800.0", "mass_t = 1800000 kg"),
    ("mass_t = 1800.0", "weight_kN = 17658"),
    ("height_m = 30.0", "height_ft = 98.4251968504"),
    ("height_m = 30.0", "height_in = 1181.1023622"),
    ("mass_t = 1800.0", "weight_kip = 3969.68172055"),
    ("mass_t = 1800.0", "mass_lb = 3969681.72055"),
    ("deck_mass_t = 900.0", "deck_weight_kips = 1984.84086028"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kip_in = 8565.22072119"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kip_ft = 102782.648654"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kip = [6744.26829133, 11240.4471522]"),
    ("coefficient_kN_s_m = 800.0", "c_kip_s_in = 4.56811771797"),
    ("gap_mm = 120.0", "gap_in = 4.72440944882"),
    ("pga_g = 0.4", "pga_m_s2 = 3.924"),
    ("forces = true", 'forces = "true"'),
    ("stiffness_kN_m = 1.5e6", "stiffness_MN_m = 1500"),
    ("coefficient_kN_s_m = 800.0", "c_N_s_m = 800000"),
    ("force_kN = 350.0", "force_N = 350000"),
    ('statistic = "mean"', 'statistic = ["mean"]'),
    ("zeta = 0.07", "zeta = 7 %"),
    ("vertical = true", 'vertical = "yes"'),
    ("mass_t = 1800.0", "shaft_mass_t = 1800.0"),
    ("mass_t = 1800.0", "mass_tonnes = 1800.0"),
    ("mass_t = 1800.0", "M = 1800.0"),
    ("mass_t = 1800.0", "m_t = 1800.0"),
    ("deck_mass_t = 900.0", "head_mass_t = 900.0"),
    ("deck_mass_t = 900.0", "lumped_mass_t = 900.0"),
    ("deck_mass_t = 900.0", "added_mass_t = 900.0"),
    ("deck_mass_t = 900.0", "carried_mass_t = 900.0"),
    ("width_m = 4.0", "base_width_m = 4.0"),
    ("width_m = 4.0", "width = 4.0"),
    ("height_m = 30.0", "pier_height_m = 30.0"),
    ("height_m = 30.0", "total_height_m = 30.0"),
    ("flexural_period_s = 0.6", "T_s = 0.6"),
    ("flexural_period_s = 0.6", "elastic_period_s = 0.6"),
    ("flexural_period_s = 0.6", "T1_s = 0.6"),
    ("vertical = true", "use_vertical = true"),
    ("vertical = true", "vertical_component = true"),
    ("scale = 1.5", "factor = 1.5"),
    ("scale = 1.5", "scaling = 1.5"),
    ("scale = 1.5", "SF = 1.5"),
    ("dt = 0.01", "sampling_interval = 0.01"),
    ("dt = 0.01", "delta_t = 0.01"),
    ("axis_deg = 35", "bearing_deg = 35"),
    ("axis_deg = 35", "orientation_deg = 35"),
    ("axis_deg = 35", "pier_azimuth_deg = 35"),
    ("axis_deg = 35", "angle = 35"),
    ("amplitude_g = 0.3", "amplitude = 0.3"),
    ("amplitude_g = 0.3", "ap_g = 0.3"),
    ("amplitude_g = 0.3", "peak_g = 0.3"),
    ("duration_s = 8.0", "length_s = 8.0"),
    ("duration_s = 8.0", "total_s = 8.0"),
    ('shape = "sine"', 'form = "sine"'),
    ('shape = "sine"', 'waveform = "sine"'),
    ("period_s = 1.25", "T = 1.25"),
    ("tolerance = 1e-3", "tol = 1e-3"),
    ("forces = true", "base_shear = true"),
    ("forces = true", "internal_forces = true"),
    ('name = "rock"', 'label = "rock"'),
    ('name = "rock"', 'title = "rock"'),
    ('name = "rock"', 'id = "rock"'),
    ('base = "rigid"', 'support = "rigid"'),
    ('base = "rigid"', 'ground = "rigid"'),
    ('base = "rigid"', 'base = "housner"'),
    ('base = "rigid"', 'base = "Rigid"'),
    ('base = "yielding"', 'base = "plastic"'),
    ('base = "yielding"', 'base = "nonlinear"'),
    ('base = "yielding"', 'base = "elastoplastic"'),
    ("restitution = 0.85", "e = 0.85"),
    ("stiffness_kN_m = 1.5e6", "K_kN_m = 1.5e6"),
    ("stiffness_kN_m = 1.5e6", "kv_kN_m = 1.5e6"),
    ("stiffness_kN_m = 1.5e6", "vertical_stiffness_kN_m = 1.5e6"),
    ("stiffness_kN_m = 1.5e6", "spring_stiffness = 1.5e6"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kNm = 1.5e6"),
    ("stiffness_kN_m = 1.5e6", '"stiffness_kN/m" = 1.5e6'),
    ("yield_kN = [3.0e4, 5.0e4]", "capacity_kN = [3.0e4, 5.0e4]"),
    ("yield_kN = [3.0e4, 5.0e4]", "strength_kN = [3.0e4, 5.0e4]"),
    ("yield_kN = [3.0e4, 5.0e4]", "bearing_capacity_kN = [3.0e4, 5.0e4]"),
    ("yield_kN = [3.0e4, 5.0e4]", "Vult_kN = [3.0e4, 5.0e4]"),
    ("zeta = 0.07", "xi = 0.07"),
    ("zeta = 0.07", "damping_ratio = 0.07"),
    ('spring = "epp"', 'spring = "elastic-perfectly-plastic"'),
    ('spring = "epp"', 'spring = "elastic perfectly plastic"'),
    ("coefficient_kN_s_m = 800.0", "c_kN_s_m = 800.0"),
    ("coefficient_kN_s_m = 800.0", "damping_coefficient_kN_s_m = 800.0"),
    ("exponent = 0.35", "velocity_exponent = 0.35"),
    ("exponent = 0.35", "a = 0.35"),
    ("force_kN = 350.0", "slip_force_kN = 350.0"),
    ("force_kN = 350.0", "Fd_kN = 350.0"),
    ("yield_mm = 8.0", "delta_y_mm = 8.0"),
    ("yield_mm = 8.0", "uy_mm = 8.0"),
    ("prestress_kN = 4000.0", "force_kN = 4000.0"),
    ("prestress_kN = 4000.0", "P0_kN = 4000.0"),
    ("prestress_kN = 4000.0", "initial_force_kN = 4000.0"),
    ("prestress_kN = 4000.0", "preload_kN = 4000.0"),
    ("prestress_kN = 4000.0", "post_tension_kN = 4000.0"),
    ("gap_mm = 120.0", "clearance_mm = 120.0"),
    ("gap_mm = 120.0", "distance_mm = 120.0"),
    ("gap_mm = 120.0", "opening_mm = 120.0"),
    ('demand = "theta_max_rad"', 'quantity = "theta_max_rad"'),
    ('demand = "theta_max_rad"', 'response = "theta_max_rad"'),
    ('demand = "theta_max_rad"', 'parameter = "theta_max_rad"'),
    ('demand = "theta_max_rad"', 'demand = "theta_max"'),
    ('statistic = "mean"', 'statistic = "avg"'),
    ("at_most = 0.05", "maximum = 0.05"),
    ("at_most = 0.05", "upper = 0.05"),
    ("at_most = 0.05", "threshold = 0.05"),
    ("at_most = 0.05", "upper_limit = 0.05"),
    ("at_most = 0.05", "less_than = 0.05"),
    ('reason = "bearing rotation"', 'comment = "bearing rotation"'),
    ('reason = "bearing rotation"', 'note = "bearing rotation"'),
    ('reason = "bearing rotation"', 'because = "bearing rotation"'),
    ("[output]", "[outputs]"),
    ("[output]", "[results]"),
    ("[[case]]", "[[foundation]]"),
    ("[[case.tendon]]", "[[case.tendons]]"),
    ("[[case.stop]]", "[case.stops]"),
    ("[[check]]", "[[limit]]"),
    ('path = "records"', "path = records"),
    ('path = "records"', 'path = "records'),
    ('path = "records"', 'path: "records"'),
    ('title = "Pier 4"', "title = 'Pier 4\""),
    ("forces = true", "forces = True"),
    ("forces = true", "forces = yes"),
    ("tolerance = 1e-3", "tolerance = 1.e-3"),
    ("tolerance = 1e-3", "tolerance = .001"),
    ("mass_t = 1800.0", "mass_t = 1,800.0"),
    ("mass_t = 1800.0", "mass_t = 1 800.0"),
    ("mass_t = 1800.0", "mass_t = 1800 t"),
    ("mass_t = 1800.0", "mass_t = 1800.0;"),
    ("width_m = 4.0", "width_m = 4."),
    ("width_m = 4.0", "width_m == 4.0"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = (3.0e4, 5.0e4)"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = 3.0e4, 5.0e4"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = [3.0e4; 5.0e4]"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = [3.0e4 5.0e4]"),
    ('path = "records"', 'path = ".\\records"'),
    # units, brackets, words of other programs
    ("period_s = 1.25", "period_s = 1250"),
    ("scale = 1.5", 'scale = "150 %"'),
    ("dt = 0.01", 'dt = "0.01 s"'),
    ("axis_deg = 35", 'axis_deg = "35°"'),
    ("axis_deg = 35", 'axis_deg = "NE"'),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_mm = 1500"),
    ("stiffness_kN_m = 1.5e6", "stiffness_N_m = 1.5e9"),
    ("stiffness_kN_m = 1.5e6", "stiffness_MN_mm = 1.5"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_MN = [30, 50]"),
    ("yield_kN = [3.0e4, 5.0e4]", 'yield_kN = ["3.0e4", "5.0e4"]'),
    ("zeta = 0.07", 'zeta = "7%"'),
    ("zeta = 0.07", "zeta_percent = 7"),
    ("coefficient_kN_s_m = 800.0", "coefficient_kNs_m = 800.0"),
    ("coefficient_kN_s_m = 800.0", "coefficient_kN_s_mm = 0.8"),
    ("coefficient_kN_s_m = 800.0", "coefficient_MN_s_m = 0.8"),
    ("force_kN = 350.0", "force_MN = 0.35"),
    ("yield_mm = 8.0", "yield_m = 0.008"),
    ("yield_mm = 8.0", "yield_cm = 0.8"),
    ("prestress_kN = 4000.0", "prestress_MN = 4"),
    ("gap_mm = 120.0", "gap_m = 0.12"),
    ("gap_mm = 120.0", "gap_cm = 12"),
    ('demand = "theta_max_rad"', 'demand = "theta_max_deg"'),
    ('demand = "theta_max_rad"', 'demand = "theta_max_mrad"'),
    ('demand = "heel_uplift_mm"', 'demand = "uplift_mm"'),
    ('path = "records"', 'path = "records\\"'),
    ('path = "records"', 'path = ".\\records\\"'),
    ('path = "records"', "path = “records”"),
    ('path = "records"', 'path = "records/*.AT2"'),
    ('path = "records"', 'path "records"'),
    ('path = "records"', "path = r'records'"),
    ("width_m = 4.0", "width_m 4.0"),
    ("width_m = 4.0", "width m = 4.0"),
    ("width_m = 4.0", "width_m = 4.0 // metres"),
    ("width_m = 4.0", "width_m = 4.0 % metres"),
    ("width_m = 4.0", "width_m = 4.0 m"),
    ("width_m = 4.0", "width_m = 4.0 [m]"),
    ("width_m = 4.0", "width_m [m] = 4.0"),
    ("width_m = 4.0", "width_m = 4.0,"),
    ("width_m = 4.0", '"width_m": 4.0,'),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5×10^6"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5*10^6"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5*10**6"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5D6"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5 e6"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5d+06"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = [3.0e4, 5.0e4"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = {3.0e4, 5.0e4}"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = 3.0e4 5.0e4"),
    ("yield_kN = [3.0e4, 5.0e4]", "yield_kN = 3.0e4:5.0e4"),
    ("[numerics]", "(numerics)"),
    ("[numerics]", "[numerics"),
    ("[numerics]", "numerics]"),
    ("[numerics]", "[numerics]]"),
    ("[numerics]", "[[numerics]]"),
    ("[numerics]", "numerics:"),
    ("[numerics]", "[ Numerics ]"),
    ("[numerics]", "<numerics>"),
    ("[pier]", "[[pier]]"),
    ("[[case]]", "[case]"),
    ("[[case]]", "[[case]"),
    ("[[case]]", "[[ Case ]]"),
    ("[[case]]", "[[load_case]]"),
    ("[[case.damper]]", "[[damper]]"),
    ("[[case.tendon]]", "[[tendon]]"),
    ("[[case.stop]]", "[[stops]]"),
    ("[[case.tendon]]", "[[case.cable]]"),
    ("[[case.damper]]", "[[case.device]]"),
    ("[motions.target]", "[target]"),
    ("[motions.target]", "[motion.target]"),
    ("[motions.target]", "[[motions.target]]"),
    ("[[motions.pulse]]", "[[pulse]]"),
    ("[[check]]", "[check]"),
    ("vertical = true", "vertical = 1"),
    ("vertical = true", "vertical = on"),
    ("vertical = true", "horizontal = true"),
    ('polarity = ["+", "-"]', 'polarity = "+-"'),
    ('polarity = ["+", "-"]', "polarity = [1, -1]"),
    ('polarity = ["+", "-"]', 'polarity = "+/-"'),
    ('polarity = ["+", "-"]', 'polarity = ["+" "-"]'),
    ('unit = "cm/s2"', "unit = cm/s2"),
    ('unit = "cm/s2"', 'acc_unit = "cm/s2"'),
    ('base = "rigid"', 'base = "rock"'),
    ('base = "yielding"', 'base = "bouc-wen"'),
    ('spring = "epp"', 'spring = "ElasticPP"'),
    ('spring = "epp"', 'uniaxialMaterial = "ElasticPP"'),
    ('kind = "viscous"', 'kind = "ViscousDamper"'),
    ('kind = "hysteretic"', 'kind = "elastic-plastic"'),
    ("at_most = 150", "max_mm = 150"),
    ("at_most = 150", "at_most = [150]"),
    ("deck_mass_t = 900.0", "axial_load_kN = 8829"),
    ("deck_mass_t = 900.0", "N_kN = 8829"),
    ("deck_mass_t = 900.0", "P_kN = 8829"),
    ("deck_mass_t = 900.0", "deck_weight_kN = 8829"),
    ("deck_mass_t = 900.0", "deck_mass_kg = 900000"),
    ("deck_mass_t = 900.0", "deck_mass = 900.0"),
    ("width_m = 4.0", "width_mm = 4000"),
    ("width_m = 4.0", "width_cm = 400"),
    ("height_m = 30.0", "clear_height_m = 30.0"),
    ("tolerance = 1e-3", "tolerance = 0.1%"),
    ("forces = true", "forces = 1"),
]
TARGET = STUDY.replace(
    "pga_g = 0.4\n",
    """\
spectrum = "EN 1998-1"
type = 1
ground = "B"
ag_g = 0.25
period_range_s = [0.4, 4.0]
damping = 0.02
""",
)
OF_TARGET = [
    ('spectrum = "EN 1998-1"', 'spectrum = "EC8"'),
    ('spectrum = "EN 1998-1"', 'spectrum = "EN1998-1:2004"'),
    ('spectrum = "EN 1998-1"', 'code = "EN 1998-1"'),
    ('ground = "B"', 'soil_class = "B"'),
    ('ground = "B"', 'ground = "b"'),
    ("period_range_s = [0.4, 4.0]", "periods_s = [0.4, 4.0]"),
    ("damping = 0.02", "damping = 2"),
    ("damping = 0.02", "xi = 0.02"),
    ("ag_g = 0.25", "ag = 0.25"),
    ("ag_g = 0.25", "agR_g = 0.25"),
    ('ground = "B"', 'ground_type = "B"'),
    ('ground = "B"', 'site_class = "B"'),
    ("type = 1", 'type = "1"'),
    ("type = 1", "spectrum_type = 1"),
    ("ag_g = 0.25", "ag_g = 2.4525"),
    ("ag_g = 0.25", "ag_m_s2 = 2.4525"),
    ("ag_g = 0.25", "a_g = 0.25"),
    ('ground = "B"', 'ground = "type B"'),
    ('ground = "B"', 'category = "B"'),
    ("type = 1", 'type = "Type 1"'),
    ("period_range_s = [0.4, 4.0]", "period_range_s = 0.4-4.0"),
    ("period_range_s = [0.4, 4.0]", "T_range = [0.4, 4.0]"),
    ("period_range_s = [0.4, 4.0]", "period_range_s = [400, 4000]"),
    ("damping = 0.02", 'damping = "2 %"'),
    ('spectrum = "EN 1998-1"', 'spectrum = "Eurocode 8"'),
    ('spectrum = "EN 1998-1"', 'spectrum = "EN 1998"'),
    ('spectrum = "EN 1998-1"', 'spectrum = "EN 1998-2"'),
    ('spectrum = "EN 1998-1"', 'spectrum = "EC8 type 1"'),
    ("ag_g = 0.25", "ag_g = 25 %"),
    ("type = 1", "type = 1\nimportance_factor = 1.2"),
    ("type = 1", "type = 1\nq = 1.5"),
]
IN_OTHER_UNITS = [  # what is meant, what is written instead, and the unit in which it is written
    ("mass_t = 1800.0", "mass_t = 1.8e6", "kg"),
    ("width_m = 4.0", "width_m = 4000", "mm"),
    ("height_m = 30.0", "height_m = 3000", "cm"),
    ("height_m = 30.0", "height_m = 30000", "mm"),
    ("flexural_period_s = 0.6", "flexural_period_s = 600", "ms"),
    ("pga_g = 0.4", "pga_g = 40", "percent"),
    ("pga_g = 0.4", "pga_g = 392.4", "cm/s²"),
    ("amplitude_g = 0.3", "amplitude_g = 30", "percent"),
    ("amplitude_g = 0.3", "amplitude_g = 294.3", "cm/s²"),
    ("quiet_s = 4.0", "quiet_s = 4000", "ms"),
    ("scale = 1.5", "scale = 150", "percent"),
    ("friction = 0.4", "friction = 40", "percent"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5e9", "N/m"),
    ("coefficient_kN_s_m = 800.0", "coefficient_kN_s_m = 0.8", "MN s/m"),
    ("yield_mm = 8.0", "yield_mm = 0.008", "m"),
    ("gap_mm = 120.0", "gap_mm = 0.12", "m"),
]
NOT_IN = [  # a value, and a unit in which it is not
    ("tolerance = 1e-3", "tolerance = 1", "percent"),
    ("width_m = 4.0", "width_m = 4e6", "mm"),
]
MANIFEST = """\
[[record]]
file = "a.txt"
azimuth = 228
unit = "cm/s2"
dt = 0.01
scale = 2.0
polarity = "-"
station = "Rinaldi"
distance_km = 6.5
magnitude = 6.7

[[record]]
file = "b.txt"
role = "vertical"
use = false
"""
OF_MANIFEST = [
    ("[[record]]", "[[records]]"),
    ('file = "a.txt"', 'filename = "a.txt"'),
    ("azimuth = 228", "direction = 228"),
    ("azimuth = 228", 'azimuth = "S48W"'),
    ('unit = "cm/s2"', 'units = "cm/s2"'),
    ("scale = 2.0", "scale_factor = 2.0"),
    ('polarity = "-"', "flip = true"),
    ("distance_km = 6.5", "Rrup_km = 6.5"),
    ("magnitude = 6.7", "Mw = 6.7"),
    ('role = "vertical"', "vertical = true"),
    ("use = false", "skip = true"),
]
RULES = "[[check]]" + STUDY.partition("[[check]]")[2]
OF_RULES = [
    ('statistic = "mean"', 'stat = "mean"'),
    ("at_most = 150", "allowable = 150"),
]
TOLD = [  # what stands in the study, what is written instead or too, what the answer says, and what it must not say
    ("mass_t = 1800.0", "mass_t = 1.800", 'deck_mass_t = 900: 500 times the mass of the pier, mass_t = 1.8; check the', "?"),
    ("mass_t = 1800.0", "weight_kN = 17658", "unknown key; write mass_t = 1800, the weight in kN over 9.81", "height_m"),
    ("mass_t = 1800.0", "weight = 17658", "weight: unknown key; write mass_t, the weight in kN over 9.81", "height_m"),
    ("prestress_kN = 4000.0", "psi_kN = 4000", "did you mean psi?", "write"),
    ("quiet_s = 4.0", "rest_m = 4.0", "did you mean quiet_s? it is in s", "write"),
    ("mass_t = 1800.0", 'mass_t = "1,800"', "expected a number (without quotes)", "?"),
    ("height_m = 30.0", "half_height_m = 15.0", "write height_m, twice the half", "?"),
    ("forces = true", 'forces = ["base_shear"]', "expected one value, not a list", "?"),
    ("forces = true", 'forces = "often"', "expected true or false (without quotes)", "?"),
    ('base = "rigid"', 'base = "rigid block"', 'expected one of "rigid", "elastic", "yielding"', "?"),
    ('statistic = "mean"', 'statistic = ["mean", "max"]', "expected one value, not a list", "?"),
    ("width_m = 4.0", "slenderness = 7.5", "write alpha = atan(width/height), in radians", "degrees"),
    ("width_m = 4.0", "thickness_m = 4.0", "write one of", "did you mean"),
    ("width_m = 4.0", "alfa = 0.13", "did you mean alpha?", "write one of"),
    ("width_m = 4.0", "width_m = 4.0\ndamping = 0.05", "damping: unknown key; write one of", "?"),
    ("width_m = 4.0", 'width_m = 4.0\nunit = "m"', "units are part of the names of keys; leave it out", "[motions]"),
    ("tolerance = 1e-3", "dt = 0.001", "write substeps, the number of steps per sample", "[motions]"),
    ("forces = true", 'path = "out"', "write --out FOLDER behind rockbatch run", "[motions]"),
    ('kind = "viscous"', 'kind = "friction pendulum"', 'expected one of "friction", "hysteretic", "viscous"', "did you mean"),
    ("exponent = 0.35", "zeta = 0.35", "write coefficient_kN_s_m, or nu = C/(M p)", "belongs"),
    ("yield_mm = 8.0", "stiffness_kN_m = 43750", "write yield_mm, the force over the stiffness", "belongs"),
    ("prestress_kN = 4000.0", "prestress_MPa = 1200", "write prestress_kN, the stress times the area", "did you mean"),
    ("at_most = 150", "at_most = 0.15", 'at_most = 0.15: in mm, as heel_uplift_mm is, hardly more', "?"),
    ("at_most = 150", 'at_most = 150\nunit = "mm"', "the unit stands in the name of the demand", "[motions]"),
    ('demand = "heel_uplift_mm"', 'demand = "uplift"', 'did you mean "heel_uplift_m" or "heel_uplift_mm"?', "theta_max_rad"),
    ('unit = "cm/s2"', 'unit = "%"', "expected one of g, g/10, mg, m/s2", "write for example"),
    ("stiffness_kN_m = 1.5e6", "stiffness_kN_m = 1.5e3", "if it is in MN, write stiffness_kN_m = 1.5e+06; else", "weight in kN"),
    ("deck_mass_t = 900.0", "cap_mass_t = 900.0", "or a [[pier.part]] for each part of it", "did you mean mass_t"),
    ("mass_t = 1800.0", "total_mass_t = 2700.0", "write mass_t, of the pier without its deck", "?"),
    ("width_m = 4.0", "b_m = 2.0", "write width_m, the whole width, twice the b of the theory", "?"),
    ("height_m = 30.0", "h_m = 15.0", "write height_m, the whole height, twice the h of the theory", "?"),
    ("mass_t = 1800.0", "mass_t = 1,800", "decimals take a point", "write"),
    ("mass_t = 1800.0", "mass_t = 1800,5", "decimals take a point", "write"),
    ("mass_t = 1800.0", "mass_t = 1800 m", "numbers no unit", "write"),
    ("zeta = 0.07", "zeta = 7 per", "numbers no unit", "write"),
    ('vertical = true', 'vertical = "often"', 'expected true, false or "required"', "?"),
    ("width_m = 4.0", "width_m = 4.0\nwidth_m = 5.0", ":5: width_m = 5.0: given in line 4 already; keep one", "write"),
    ("width_m = 4.0", "half_width_mm = 2000", "unknown key; write width_m, twice the half", "= 2"),
    ('name = "uplift"', 'name = "uplift"\nname = "lift"', ':79: name = "lift": given in line 78 already', "write"),
    ("forces = true", "forces = true\n[output]", "cannot declare ('output',) twice", "write"),
    ("width_m = 4.0", "E_GPa = 30", "a pier is rigid unless its case says", "did you mean"),
    ("width_m = 4.0", "width_m = 4.0\nlength_m = 9.0", "the model is plane, so that the size across", "write"),
    ("mass_t = 1800.0", "density = 2.5", "write mass_t, the density times the volume", "?"),
    ("friction = 0.4", "friction_deg = 21.8", "write friction, the tangent of the angle", "?"),
    ('kind = "viscous"', 'kind = "damper"', 'expected one of "friction", "hysteretic", "viscous"', "?"),
    ('demand = "theta_max_rad"', 'demand = "drift"', 'did you mean "top_drift_m" or "top_drift_mm"?', "theta"),
    ('spring = "epp"', 'spring = "Steel01"', 'expected one of "bouc-wen", "epp", "hardening"', "?"),
    ("tolerance = 1e-3", "tolerance = 1e-3\nmax_iter = 50", "there is one method; leave it out", "write"),
    ("forces = true", "forces = true\npdf = true", "makes a PDF with --sheet; leave it out", "did you mean"),
    ('base = "rigid"', "base = rigid block", "texts belong in quotes", "write"),
    ('path = "records"', 'path = "records\\near"', 'did you mean "records/near"?', "records?"),
]  # fmt: skip


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "records").mkdir()
    for name in ("a.txt", "b.txt"):
        (tmp_path / name).touch()
    return tmp_path


def problems(folder, text, load=load_study):
    try:
        load(write_study(folder, text))
    except InputError as error:
        return error.messages
    return ()


def followed(text, problem):
    """Return the text with the advice of a message taken literally, the first where it gives several."""
    number = int(re.search(r"\.toml:(\d+): ", problem)[1])
    lines = text.split("\n")
    line = lines[number - 1]
    header = re.search(r"write \[\[([\w.]+)\]\](?: in line (\d+), too)?", problem)
    written = re.search(r"(?:write(?: for example)? |it belongs under )(.+)", problem)
    meant = re.search(r"did you mean (.+?)(?: or .+)?\?", problem)
    percent = re.search(r"(\S+) = .*; if it is in percent, write (\S+)$", problem)
    if percent:
        lines[number - 1] = f"{percent[1]} = {percent[2]}"
    elif meant and "unknown" in problem:
        name = re.search(r"(\S+): unknown", problem)[1].strip('"')
        lines[number - 1] = line.replace(name, meant[1], 1)
    elif meant:
        value = re.search(r" = (.+?): (?:did you mean|expected|no such)", problem)[1]
        lines[number - 1] = line.replace(value, meant[1], 1)
    elif header:
        name, place = header.groups()
        places = [int(place) - 1] if place else range(len(lines))
        for n in places:
            lines[n] = f"[[{name}]]" if lines[n].strip() == f"[{name}]" else lines[n]
        if not place and re.fullmatch(r"\W*[\w. ]+\W*", line):
            lines[number - 1] = f"[[{name}]]"
    elif problem.endswith("leave it out"):
        del lines[number - 1]
    else:
        lines[number - 1] = _longest_toml(written[1])
    return "\n".join(lines)


def _longest_toml(advice):
    ends = [len(advice), *(match.start() for match in re.finditer(r", |; | \(|$", advice))]
    for end in sorted(ends, reverse=True):
        try:
            tomllib.loads(advice[:end])
        except ValueError:
            continue
        return advice[:end]
    raise AssertionError(f"no TOML in {advice!r}")


def told_until_right(folder, text, load=load_study):
    """Return what is said while the advice is followed, a few times at most, and the text that is right in the end."""
    messages = []
    for _ in range(4):
        wrong = problems(folder, text, load)
        if not wrong:
            return messages, text
        messages.append(wrong[0])
        text = followed(text, wrong[0])
    raise AssertionError("\n".join(messages))


NUMBER = re.compile(r"(?<![\w.])-?\d+\.?\d*(?:e[+-]?\d+)?(?![\w.])")


def meaning(loaded):
    """Return all that a study, manifest or file of rules says, its numbers to the six digits of converted ones."""
    if isinstance(loaded, Study):
        loaded = (loaded.cases, loaded.motions, loaded.numerics, loaded.output, loaded.checks, loaded.varied)
    return NUMBER.sub(lambda number: f"{float(number[0]):.5g}", repr(loaded))


def manifest(path):
    read = Manifest.read([path])
    read.finish()
    return [sorted(entry.values.items()) for entries in read.entries.values() for entry in entries]


@pytest.mark.sweep(fast=50)
@pytest.mark.parametrize(
    ("whole", "load", "meant", "written"),
    [
        *((STUDY, load_study, *row) for row in REPLACED), *((TARGET, load_study, *row) for row in OF_TARGET),
        *((MANIFEST, manifest, *row) for row in OF_MANIFEST), *((RULES, load_rules, *row) for row in OF_RULES),
    ],
)  # fmt: skip
def test_advice_followed_to_the_letter_leads_to_what_was_meant(folder, whole, load, meant, written):
    wrong = whole.replace(meant, written, -1 if written.startswith("[") else 1)
    assert wrong != whole
    messages, text = told_until_right(folder, wrong, load)
    assert messages
    assert meaning(load(write_study(folder, text))) == meaning(load(write_study(folder, whole)))
    assert all(len(message.removeprefix(str(folder))) < 250 for message in messages)


@pytest.mark.sweep(fast=6)
@pytest.mark.parametrize(("meant", "written", "unit"), IN_OTHER_UNITS)
def test_an_unusual_value_has_beside_it_what_it_is_in_other_units(folder, meant, written, unit):
    wrong = STUDY.replace(meant, written, 1)
    message = next(text for text in problems(folder, wrong) if f"{written.split(' ')[0]} = " in text)
    (line,) = re.findall(rf"; if it is in {unit}, write (\w+ = \S+?);", message)
    text = wrong.replace(written, line, 1)
    assert meaning(load_study(write_study(folder, text))) == meaning(load_study(write_study(folder, STUDY)))


@pytest.mark.parametrize(("meant", "written", "unit"), NOT_IN)
def test_no_unit_is_named_in_which_the_value_is_still_unusual(folder, meant, written, unit):
    (message,) = problems(folder, STUDY.replace(meant, written, 1))
    assert f"if it is in {unit}," not in message


@pytest.mark.parametrize(("meant", "written", "says", "never"), TOLD)
def test_a_word_without_an_equal_is_refused_and_nothing_suggested(folder, meant, written, says, never):
    messages = problems(folder, STUDY.replace(meant, written, 1))
    (message,) = (each.removeprefix(str(folder)) for each in messages if says in each)
    assert never not in message


def test_a_mass_that_is_a_weight_is_suspected_before_the_springs_under_it(folder):
    """A deck of 1000 t written in kN: stronger springs would carry a pier that is ten times as heavy."""
    messages = problems(folder, STUDY.replace("deck_mass_t = 900.0", "deck_mass_t = 9810"))
    assert len(messages) == 2  # one for each of two springs
    assert all(
        "; if a mass is a weight in kN, write it over 9.81; else write yield_kN above" in words for words in messages
    )
    assert not problems(folder, STUDY.replace("deck_mass_t = 900.0", f"deck_mass_t = {9810 / 9.81}"))


def test_a_slip_that_the_parser_notices_later_is_shown_where_it_is(folder):
    (message,) = problems(folder, STUDY.replace('title = "Pier 4"', "title = 'Pier 4\""))
    assert ":1: not valid TOML" in message
    assert message.endswith('write title = "Pier 4"')


def test_a_line_that_could_mean_several_things_gets_no_remedy():
    for line in (
        "a = 1,5",
        "a = 1,800",
        "a_t = 1800 m",
        "a_kN_m = 18 t",
        "a = 1,5 %",
        "a = rigid block",
        "a = 'it's'",
        "a = [1, 2]",
        "a = 1 8",
    ):
        assert meant_line(line) == "", line
