"""Filter: who may meet whom, before any narrow phase."""

from dataclasses import dataclass
from typing import ClassVar

from physics import checks


@dataclass(frozen=True)
class Filter:
    """Two shapes meet if a.membership & b.mask and b.membership & a.mask; 32 bits each. Raises ValueError."""

    ALL: ClassVar["Filter"]  # meets everybody

    membership: int = 1
    mask: int = 0xFFFFFFFF

    def __post_init__(self):
        object.__setattr__(self, "membership", checks.whole("membership", self.membership, 0, 0xFFFFFFFF))
        object.__setattr__(self, "mask", checks.whole("mask", self.mask, 0, 0xFFFFFFFF))

    @classmethod
    def from_packed(cls, bits: int) -> "Filter":
        """Low 16 bits membership, high 16 bits mask."""
        bits = checks.whole("bits", bits, 0, 0xFFFFFFFF)
        return cls(bits & 0xFFFF, bits >> 16)


Filter.ALL = Filter(0xFFFFFFFF, 0xFFFFFFFF)
