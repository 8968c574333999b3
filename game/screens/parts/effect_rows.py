"""The panel's table of all effects: declared or not, time per step in this scene, number of kernels."""

from game.drawing.colors import GREEN
from game.drawing.number_text import plain_name
from game.measure.effect_costs import EffectCost
from game.measure.ledger import EFFECTS
from game.screens.parts.measuring import Measuring
from game.screens.parts.panel import HEAD, LINE, NOTE, Row

WAITS = "..."
UNKNOWN = "-"


def effect_rows(measuring: Measuring) -> list[Row]:
    """Return a head, a line per effect, and a line on the state of the measurement."""
    ledger = measuring.ledger
    rows = [Row(HEAD, "Effects", cells=("us a step", "kernels"))]
    for name in EFFECTS:
        declared = getattr(measuring.world.effects, name)
        known = ledger.effects.get(name, EffectCost(name, declared))
        cells = price_text(known, ledger.busy), kernels_text(known, ledger.busy)
        rows.append(Row(LINE, plain_name(name), on=declared, color=GREEN, cells=cells, hint=hint_of(known)))
    if ledger.trouble:
        rows.append(Row(NOTE, ledger.trouble))
    return rows


def price_text(known: EffectCost, busy: bool) -> str:
    """Return the time per step in microseconds; a time within the scatter of the runs is shown as none."""
    price = known.price
    if price is None:
        return WAITS if busy else UNKNOWN
    return "0" if abs(price) <= known.noise else f"{1e6 * price:+,.{digits(price)}f}"


def kernels_text(known: EffectCost, busy: bool) -> str:
    """Return the number of kernels compiled for it."""
    if known.kernels is None:
        return WAITS if busy else UNKNOWN
    return f"{known.kernels}"


def hint_of(known: EffectCost) -> str:
    """Return a short description of an effect."""
    price, noise = known.price, known.noise
    if price is None:
        return "declared" if known.declared else "absent"
    words = f"{1e6 * price:+,.{digits(price)}f} us, +-{1e6 * noise:,.{digits(noise)}f}"
    return f"{'declared' if known.declared else 'put in idle'}: {words}"


def digits(seconds: float) -> int:
    """Return the decimals of a time in microseconds: none from ten on."""
    return 0 if abs(seconds) >= 1e-5 else 1
