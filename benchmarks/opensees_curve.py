"""A rocking pier written out in OpenSees, in kN, m, t and s, for those who know it: docs/pages/questions/opensees.md.

python -m pip install openseespy
python benchmarks/opensees_curve.py > benchmarks/opensees_curve.csv
"""

import math

import openseespy.opensees as ops

b, h, mass, g = 2.0, 15.0, 2000.0, 9.81  # half of the width, height of the centre of mass, mass
stiffness = 1e6  # of the support at either edge, which pushes and never pulls
inertia = mass * (b**2 + h**2) / 3.0  # of a rectangle, about its centre
dt, steps = 0.005, 8  # the motion's time step, and steps of the analysis in it
times = [i * dt for i in range(1201)]
ground = [2.2 * math.sin(2.0 * math.pi * t / 1.5) if t <= 1.5 else 0.0 for t in times]

ops.model("basic", "-ndm", 2, "-ndf", 3)
for tag, x, y in ((1, -b, 0.0), (2, -b, 0.0), (3, b, 0.0), (4, b, 0.0), (5, 0.0, h), (6, 0.0, 0.0)):
    ops.node(tag, x, y)
for tag, fixed in ((1, (1, 1, 1)), (3, (1, 1, 1)), (6, (1, 0, 0))):
    ops.fix(tag, *fixed)  # the ground, and the middle of the base sideways
ops.mass(5, mass, mass, inertia)
ops.geomTransf("Corotational", 1)
rigid = 1e4 * stiffness  # beams that hardly bend
for tag, (start, end) in enumerate(((6, 5), (2, 6), (6, 4)), start=1):
    ops.element("elasticBeamColumn", tag, start, end, rigid * h, 1.0, rigid * h**3, 1)
ops.uniaxialMaterial("ENT", 1, stiffness)
ops.uniaxialMaterial("Elastic", 2, 1e-7 * stiffness)  # or the first tangent would be singular
ops.uniaxialMaterial("Parallel", 3, 1, 2)
ops.element("zeroLength", 11, 1, 2, "-mat", 3, "-dir", 2)
ops.element("zeroLength", 12, 3, 4, "-mat", 3, "-dir", 2)

ops.constraints("Plain")
ops.numberer("RCM")
ops.system("BandGeneral")
ops.test("NormDispIncr", 1e-10, 50)
ops.algorithm("Newton")
ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
ops.load(5, 0.0, -mass * g, 0.0)
ops.integrator("LoadControl", 0.1)
ops.analysis("Static")
assert ops.analyze(10) == 0
ops.loadConst("-time", 0.0)
ops.wipeAnalysis()

ops.constraints("Plain")
ops.numberer("RCM")
ops.system("BandGeneral")
ops.test("NormDispIncr", 1e-10, 50)
ops.algorithm("Newton")
ops.timeSeries("Path", 2, "-dt", dt, "-values", *ground)
ops.pattern("UniformExcitation", 2, 1, "-accel", 2)
ops.integrator("Newmark", 0.5, 0.25)
ops.analysis("Transient")
print("t_s,theta_rad")
for i, t in enumerate(times):
    if i:
        assert ops.analyze(steps, dt / steps) == 0
    if i % 4 == 0:
        print(f"{t:.2f},{-ops.nodeDisp(5, 3):.6f}")
