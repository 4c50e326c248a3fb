"""User-defined laws, as callables of NumPy arrays."""
from __future__ import annotations

from collections.abc import Callable

from numpy.typing import ArrayLike

from mortier import _core


def register_law(name: str, rate: Callable[..., ArrayLike],
                 derivative: Callable[..., ArrayLike] | None = None, *, of_strain: bool = False) -> None:
    """Makes law = "name" known to the scenes of this process that are read from now on.

    rate(stress, strain, **parameters) gives the viscoplastic strain rate [1/s], n x 4, of n points at once.
    stress [Pa] and strain [-] are n x 4: 11, 22, 12, 33 (eps12, not 2 eps12; in plane stress s33 is 0 and
    eps33, which is not known, NaN). parameters are those of the scene. Where the rate depends on the strain
    of_strain must say so. derivative gives its derivatives [1/(Pa s)], n x 4 x 4, by 11, 22, 12, 33 of the
    stress in the last place, and with of_strain n x 4 x 8, by those of the strain after them; without it
    differences are taken. Of bodies in space there are six components in place of four, 13 and 23 after them.
    Both are called in the threads of a run; what they raise ends it.

    InputError: a name that is not letters, digits, _ and -, or that of a law of mortier's own.
    """
    _core.register_law(name, rate, derivative, of_strain)


def forget_law(name: str) -> None:
    """Scenes that were read keep it."""
    _core.forget_law(name)
