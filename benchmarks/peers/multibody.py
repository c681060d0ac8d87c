"""Solver (e): Exudyn's geometrically exact planar beam (C++), on the cantilever of `statics` and on the rods in the
plane.

Elements have two or three nodes. Assembling the model, in Python, is not timed; the solve is. The static solver is
Newton's method with one load step or several, its own choices otherwise. The relaxing rods are bodies without mass,
each coordinate of a node with a dashpot to the ground, lumped by Simpson's rule; that can stand for the friction
only because it is the same along and across the rod. Implicit steps of equal length, three-node elements; both its
generalised alpha method, at any spectral radius, and its trapezoidal rule turn out to be of first order without
mass.
"""

import time

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    Force,
    MarkerNodeCoordinate,
    MarkerNodePosition,
    NodePointGround,
    NodeRigidBody2D,
    ObjectBeamGeometricallyExact2D,
    ObjectConnectorCoordinate,
    ObjectConnectorCoordinateSpringDamper,
)

from benchmarks.peers.problems import UNTIL, Problem, error, start
from benchmarks.peers.statics import LOAD, STIFFNESS, tip
from geocosserat.discretisation.mesh import Array

DENSE = 20
"""Elements up to which dense matrices are faster."""


class _Beam:
    """A clamped beam of length 1: elements of equal length with two or three nodes."""

    def __init__(
        self, elements: int, nodes: int, stiffness: tuple[float, ...], pose: Array | None, mass: float
    ) -> None:
        self._container = exu.SystemContainer()
        self.system = self._container.AddSystem()
        step = nodes - 1
        self.u = np.linspace(0.0, 1.0, elements * step + 1)
        begin = np.zeros((len(self.u), 3)) if pose is None else pose - np.outer(self.u, [1.0, 0.0, 0.0])
        self.nodes = [
            self.system.AddNode(NodeRigidBody2D(referenceCoordinates=[u, 0.0, 0.0], initialCoordinates=list(away)))
            for u, away in zip(self.u, begin, strict=True)
        ]
        for i in range(elements):
            self.system.AddObject(
                ObjectBeamGeometricallyExact2D(
                    nodeNumbers=self.nodes[i * step : i * step + nodes],
                    length=1.0 / elements,
                    massPerLength=mass,
                    crossSectionInertia=mass,
                    bendingStiffness=stiffness[2],
                    axialStiffness=stiffness[0],
                    shearStiffness=stiffness[1],
                )
            )
        ground = self.system.AddNode(NodePointGround())
        self.ground = self.system.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        for coordinate in range(3):
            markers = [self.ground, self.marker(0, coordinate)]
            self.system.AddObject(ObjectConnectorCoordinate(markerNumbers=markers))
        self.settings = exu.SimulationSettings()
        self.settings.solution.file.write = False
        kinds = exu.LinearSolverType
        self.settings.linearSolver.solverType = kinds.EigenSparse if elements > DENSE else kinds.EXUdense

    def marker(self, node: int, coordinate: int) -> int:
        """Of a coordinate of a node."""
        made: int = self.system.AddMarker(MarkerNodeCoordinate(nodeNumber=self.nodes[node], coordinate=coordinate))
        return made

    def positions(self) -> Array:
        """Of the nodes (nodes, 2)."""
        kind = exu.OutputVariableType.Position
        return np.array([self.system.GetNodeOutput(node, kind)[:2] for node in self.nodes])


def settle(elements: int, nodes: int, load_steps: int) -> tuple[float, float, int]:
    """Error of the tip of the cantilever, seconds, elements."""
    beam = _Beam(elements, nodes, STIFFNESS, None, 1.0)
    end = beam.system.AddMarker(MarkerNodePosition(nodeNumber=beam.nodes[-1]))
    beam.system.AddLoad(Force(markerNumber=end, loadVector=[0.0, -LOAD, 0.0]))
    beam.system.Assemble()
    beam.settings.staticSolver.numberOfLoadSteps = load_steps
    beam.settings.staticSolver.verboseMode = 0
    begin = time.perf_counter()
    done = beam.system.SolveStatic(beam.settings)
    seconds = time.perf_counter() - begin
    if done is False:
        raise RuntimeError("Exudyn: Newton's method failed")
    return float(np.linalg.norm(beam.positions()[-1] - tip())), seconds, elements


def relax(problem: Problem, elements: int, steps: int) -> tuple[float, float, int]:
    """Error of a relaxing rod in the plane, seconds, steps."""
    pose = start(problem, np.linspace(0.0, 1.0, 2 * elements + 1))
    beam = _Beam(elements, 3, problem.stiffness, pose, 0.0)
    share = np.zeros(len(pose))
    for i in range(elements):
        share[2 * i : 2 * i + 3] += np.array([1.0, 4.0, 1.0]) / (6.0 * elements)
    for node, part in enumerate(share[1:], start=1):
        for coordinate in range(3):
            markers = [beam.ground, beam.marker(node, coordinate)]
            damping = part * problem.friction[coordinate]
            beam.system.AddObject(ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, damping=damping))
    beam.system.Assemble()
    integration = beam.settings.timeIntegration
    integration.endTime, integration.numberOfSteps = UNTIL, steps
    integration.generalizedAlpha.computeInitialAccelerations = False  # there is no mass
    beam.settings.solution.sensors.writePeriod = UNTIL
    begin = time.perf_counter()
    done = beam.system.SolveDynamic(beam.settings)
    seconds = time.perf_counter() - begin
    if done is False:
        raise RuntimeError("Exudyn: Newton's method failed")
    return error(problem, beam.u, beam.positions()), seconds, steps
