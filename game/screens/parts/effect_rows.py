"""The panel's table of effects: whether the scene declares each effect, its time per step, and its kernels."""

from game.drawing.colors import GREEN
from game.drawing.number_text import plain_name
from game.measure.effect_costs import EffectCost
from game.measure.effect_totals import bars_of
from game.measure.ledger import EFFECTS
from game.screens.parts.measuring import Measuring
from game.screens.parts.panel import HEAD, LINE, NOTE, Row

TITLE = "Effects"
WAITS = "..."
UNKNOWN = "-"


def effect_rows(measuring: Measuring) -> list[Row]:
    """Return the panel's rows about the costs of effects: a heading, a row for each choice, and a row for each effect.

    If the measurement failed, a note is added.
    """
    ledger = measuring.ledger
    rows = [Row(HEAD, TITLE, cells=("us a step", "kernels")), *_choices(measuring)]
    for name in EFFECTS:
        declared = getattr(measuring.world.effects, name)
        known = ledger.effects.get(name, EffectCost(name, declared))
        cells = price_text(known, ledger.busy), kernels_text(known, ledger.busy)
        rows.append(Row(LINE, plain_name(name), on=declared, color=GREEN, cells=cells, hint=hint_of(known)))
    if ledger.trouble:
        rows.append(Row(NOTE, ledger.trouble))
    return rows


def _choices(measuring):
    """Return a row for each choice of effects: as declared, all, and the fewest possible.

    The hints of the rows contain the time of the first step and the bytes of the tables.
    """
    rows = []
    for bar in bars_of(measuring.ledger.totals):
        (_, time), (_, kernels), (_, start), (_, size) = bar.cells
        hint = f"{start} ms to the first step, {size} kB"
        rows.append(Row(LINE, bar.name, on=True, color=bar.color, cells=(time, kernels), hint=hint))
    return rows


def price_text(known: EffectCost, busy: bool) -> str:
    """Return the time [us] that an effect adds to a step, as text. known: EffectCost of the effect.

    The text is "0" if the time is not greater than the scatter of the runs. It is "-" if the time is unknown, and "..."
    while the time is being measured. busy: whether measurements are running.
    """
    price = known.price
    if price is None:
        return WAITS if busy else UNKNOWN
    return "0" if abs(price) <= known.noise else f"{1e6 * price:+,.{digits(price)}f}"


def kernels_text(known: EffectCost, busy: bool) -> str:
    """Return the number of kernels compiled for an effect, as text. known: EffectCost of the effect.

    The text is "-" if the number is unknown, and "..." while it is being counted. busy: whether measurements are
    running.
    """
    if known.kernels is None:
        return WAITS if busy else UNKNOWN
    return f"{known.kernels}"


def hint_of(known: EffectCost) -> str:
    """Return a short text about an effect: whether the scene declares it, and its measured time with the scatter.

    known: EffectCost of the effect.
    """
    price, noise = known.price, known.noise
    if price is None:
        return "declared" if known.declared else "absent"
    words = f"{1e6 * price:+,.{digits(price)}f} us, +-{1e6 * noise:,.{digits(noise)}f}"
    return f"{'declared' if known.declared else 'put in idle'}: {words}"


def digits(seconds: float) -> int:
    """Return the number of decimals for a time [s] that is shown in microseconds: none from 10 us on."""
    return 0 if abs(seconds) >= 1e-5 else 1
