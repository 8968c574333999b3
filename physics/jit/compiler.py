"""Whether there is a compiler, and which. What else here imports numba is imported only where there is one."""

import os
from typing import Any

try:
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        raise ImportError("NUMBA_DISABLE_JIT is set")
    # Vector maths from SVML rounds differently from libm; compiled and plain runs must agree to the bit.
    os.environ.setdefault("NUMBA_DISABLE_INTEL_SVML", "1")
    import numba as installed

    numba: Any = installed  # Any: it declares no type for half of what is used here
    JIT = True
except ImportError:
    numba = None
    JIT = False

LISTING = JIT and os.environ.get("HITBOX_LISTING", "") == "1"  # this process only compiles: kernels are noted, not run
