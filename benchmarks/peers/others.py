"""Packages that were looked at and are not among the solvers, or not everywhere, and why; printed below the tables."""

LOOKED_AT = """\
Looked at on the Python package index:

* Exudyn 1.13.6 (C++, multibody dynamics) has geometrically exact planar beams and a static solver: timed on the
  cantilever, and on the rods in the plane, whose friction happens to be the same along and across them. Friction
  that differs and turns with the cross-section is not among its loads, and its implicit methods are of first order
  where nothing has mass.
* PyElastica 1.0.0 (numba, explicit, with inertia) is timed on the cantilever. Overdamped motion is out of its
  reach: its step is that of the stretching waves, whatever the damping. Its extensions (br2, hsa-pyelastica,
  magneto-pyelastica, elastica-rhino) have the same solver.
* cosseratbench 0.3.0 has no solver: it drives PyElastica, MuJoCo's cables and dismech on scenes of its own. Its
  cantilever is bent by two hundredths of its length; it too finds that PyElastica's error at a clamp is of first
  order.
* soromox 0.5.0, and jsrm 0.0.18 before it (JAX), model soft robots of a few segments of constant strain, with
  inertia; neither has a static solver or motion without mass.
* dismech-newton 0.1.0 has discrete elastic rods, which do not shear, in NVIDIA's simulator Newton.
* jax-spcs-kinematics 0.0.1 has kinematics only.
"""
