"""What small motions of the nodes do to the turn: the matrix A(E) of the scheme, and back."""

import numpy as np

from geocosserat.algebra.groups import Group
from geocosserat.discretisation.mesh import Array, Mesh


def strain_rates(mesh: Mesh, group: Group, turn: Array) -> Array:
    """(d points, d nodes) the rates of the turn (d, points), component by component, for twists of the nodes, node by
    node: V' + ad_E V."""
    n, p, d = mesh.elements, mesh.degree, group.dimension
    values, slopes = mesh.reference.values, mesh.reference.slopes
    ad = group.ad(turn.T).reshape(n, p, d, d)
    A = np.zeros((d, n, p, n * p + 1, d))
    for e in range(n):
        own = slice(e * p, e * p + p + 1)
        A[:, e, :, own] = np.einsum("qm,qij->iqmj", values, ad[e])
        A[:, e, :, own] += np.einsum("qm,ij->iqmj", slopes / mesh.half[e], np.eye(d))
    return A.reshape(d * n * p, -1)
