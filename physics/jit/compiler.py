"""The compiler: whether there is one, and the only place that imports it."""

import os
import warnings
from importlib.util import find_spec
from typing import Any

# Vector maths from SVML rounds differently from libm; compiled and plain runs must agree to the bit.
if os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0"):
    os.environ.setdefault("NUMBA_DISABLE_INTEL_SVML", "1")
    JIT = find_spec("numba") is not None
else:
    JIT = False

_found: list[Any] = []  # numba, or None where it cannot be imported


def compiler() -> Any:
    """Return numba, imported at the first call; None where it cannot be imported, which is reported once."""
    if not _found:
        try:
            import numba

            _found.append(numba)
        except ImportError as error:
            warnings.warn(f"numba cannot be imported ({error}): kernels run as Python, slower", stacklevel=2)
            _found.append(None)
    return _found[0]
