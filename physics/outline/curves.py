"""Outline lines along the round curves of a drawing. The lines have nearly the directions of the curve."""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.outline.paths import (
    PLACE,
    RUN,
    Prices,
    cheapest,
    cheapest_loop,
    down_of,
    put_loop,
    put_place,
    right_of,
    stays,
)

# ---- curves ----------------------------------------------------------------------------------------------------------
# The fewest lines within `reach` of the cracks (pixel edges) have wrong directions on a round curve, by up to half a
# right angle where the curve is level, upright or diagonal, because a line ends next to a single pixel there. So two or
# more consecutive lines that turn like an arc are computed again. Candidate corners (places) are moved from the cracks
# to a smooth curve: the least-squares parabola through the middles of the cracks around each place (Savitzky and Golay
# 1964). The cost of a line grows with its angles to this curve. The inequality of contour.outline also holds for these
# lines, because places stay within `reach` of their cracks.
#
# Long lines, lines that turn far, and lines at fixed corners between them are unchanged to the bit: walls, slopes and
# the corners of boxes.

FIT = 12  # [cracks] most that a fit uses on either side of a place; equal to SEEN. Fewer: coarser directions
NARROW_FIT = 6  # [cracks] a curve with a smaller fit is too narrow and keeps its lines: radii of less than 6 px
LEAST_FIT = 3  # [cracks] least that a fit uses on either side, at the ends of a curve
FIT_TURN = 0.95  # [rad] largest turn of the curve on either side within a fit, because a parabola fits only a short arc
RISE = 0.9  # [px] greatest height over its chord of an arc that a line replaces; higher: a long straight line
TURN = 1.0  # [rad] greatest turn from a curve's line to the next one
CLEAR = 3.0  # [px] a curve has at least two lines of this length
GENTLE = 0.12  # [rad] a stretch whose turns are all smaller is smooth enough and keeps its lines
SPIKE = 1.5  # [px] a shorter line has no direction
LOOKED = 3  # number of neighbouring lines examined to find the turn at a line's end
SPIKE_SHARE = 0.25  # a neighbour shorter than this share of the line does not end the search for the turn
DENT = 6.0  # [px] greatest length of a line in a curve that turns to either side at its ends, …
WAVE = 0.2  # [px] … or greatest height of such a line as an arc with its larger turn
ANGLE_PRICE = 4.5  # [corners / (rad2 px)] lines turn by about 8 degrees at a radius of 60 px, 14 at 10 px, 5 at 200 px
CURVE_PRICES = Prices(0.0, ANGLE_PRICE)
JOINING = 0.25  # [px] least `smooth` at which lines join diagonal pixels (8-connected pieces) and follow curves
INSIDE = 0.96  # largest distance of a place from its crack as a share of `reach`
GRAINS = 1024.0  # [1/px]
GRAIN = 1.0 / GRAINS  # [px] grid of places: sums and products with whole pixels are exact
LEVEL = 0.3  # least cosine between curve and run at which a fitted point moves along the curve to the place's normal
APART = 0.75  # [cracks] least distance of a place from the ends of a curve

STRAIGHT_LINE, CURVED_LINE, SPIKE_LINE = 0, 1, 2

VERTEX = np.dtype(
    [  # the end of a line and the start of the next one
        ("x", np.float64),
        ("y", np.float64),
        ("at", np.float64),  # [cracks] along the path
        ("anchor", np.bool_),  # a fixed corner: no curve passes it
        ("broken", np.bool_),  # the next line passes a corner where no line may end
        ("along_x", np.float64),  # direction of the next line
        ("along_y", np.float64),
        ("length", np.float64),  # [px] length of the next line
        ("kind", np.int64),  # kind of the next line: STRAIGHT_LINE, CURVED_LINE, SPIKE_LINE
    ],
    align=True,
)
POINT = np.dtype([(name, np.float64) for name in ("x", "y", "at")], align=True)  # at: [cracks] along the path
FITTED = np.dtype([(name, np.float64) for name in ("x", "y", "along_x", "along_y")], align=True)


class Lines(NamedTuple):
    """Scratch arrays of the search for lines along a path, large enough for the longest possible path."""

    runs: np.ndarray  # RUN
    places: np.ndarray  # PLACE
    chain: np.ndarray  # int64
    vertices: np.ndarray  # VERTEX
    middles: np.ndarray  # POINT: middle of each crack of the path, from row FIT on
    fitted: np.ndarray  # FITTED: fit at each crack of a curve, from the crack before its start on


class Path(NamedTuple):
    """Parameters of a path along pixel edges, whose runs (straight rows of edges) are in Lines.runs."""

    count: int  # runs
    cracks: int
    closed: bool
    reach: float  # [px] as in outline
    low: float  # [px] least and …
    high: float  # … greatest coordinate that lines may have
    begin: float  # [cracks] along the path: lines end only after this position …
    end: float  # … and before this position, or at the ends of the path
    curves: bool  # whether lines along round curves are computed again


class Curve(NamedTuple):
    """A round section of a path, and the range of pixel edges to which the curve is fitted."""

    start: float  # [cracks] along the path
    end: float
    low: float  # [cracks] the curve is fitted to the path from here …
    high: float  # … to here
    half: int  # largest number of cracks on either side of a place in a fit; 0: too narrow for a fit


def room_for_lines(cracks: int) -> Lines:
    """Return scratch arrays for paths of up to `cracks` pixel edges."""
    return Lines(
        np.zeros(cracks, RUN),
        np.zeros(4 * cracks + 8, PLACE),
        np.zeros(4 * cracks + 8, np.int64),
        np.zeros(2 * cracks + 2, VERTEX),
        np.zeros(cracks + 2 * FIT, POINT),
        np.zeros(cracks + 4, FITTED),
    )


@subkernel
def read_vertices(found, path, workspace):
    """Write the vertices (ends of lines) that the line search found to workspace.vertices. Return the number of lines.

    found: number of entries of workspace.chain, which lists the row of each vertex in workspace.places, from last to
    first; path: the Path; workspace: scratch arrays (Lines).
    """
    vertices, places = workspace.vertices, workspace.places
    count = found - 1
    turns = places[workspace.chain[found - 1]].at // path.cracks if path.closed else 0.0
    for k in range(found):
        here = workspace.chain[found - 1 - k]
        place = places[here]
        vertex = vertices[k]
        vertex.x, vertex.y = place.x, place.y
        vertex.at = place.at - turns * path.cracks
        vertex.anchor = place.anchor
        vertex.broken = False
        vertex.kind = STRAIGHT_LINE
        if k == count:
            break
        for other in range(here + 1, workspace.chain[found - 2 - k]):
            if path.begin < places[other].at < path.end:
                vertex.broken = vertex.broken or (places[other].corner and not places[other].allowed)
    for k in range(count):
        vertex = vertices[k]
        x, y = vertices[k + 1].x - vertex.x, vertices[k + 1].y - vertex.y
        vertex.length = math.sqrt(x * x + y * y)
        vertex.along_x = x / vertex.length if vertex.length > 0.0 else 0.0
        vertex.along_y = y / vertex.length if vertex.length > 0.0 else 0.0
    return count


@subkernel
def turn_between(first, second):
    """Return the angle [rad] from the line that starts at vertex `first` to the line that starts at vertex `second`.

    The angle is > 0 for a turn that is clockwise on the screen. first, second: VERTEX rows.
    """
    return math.atan2(
        first.along_x * second.along_y - first.along_y * second.along_x,
        first.along_x * second.along_x + first.along_y * second.along_y,
    )


@subkernel
def turn_beyond(k, step, count, closed, vertices):
    """Return (turn [rad] between line k and its neighbouring lines on one side, whether there is such a line).

    step: 1 for the lines after line k, -1 for those before it. The turn is the smallest one between line k and the next
    few lines, up to the first that is not much shorter than line k. Lines shorter than SPIKE px are ignored. No line
    follows beyond a fixed corner (anchor) or the end of an open path. count: number of lines of the path; closed:
    whether the path is closed; vertices: VERTEX rows, the starts of the lines.
    """
    j = k
    least = 0.0
    found = False
    for _ in range(LOOKED):
        if vertices[j + 1 if step > 0 else j].anchor:
            break
        j += step
        if closed:
            j = (j + count) % count
        if j < 0 or j >= count:
            break
        if vertices[j].length < SPIKE:
            continue
        turn = turn_between(vertices[k], vertices[j]) * step
        least = turn if not found or abs(turn) < abs(least) else least
        found = True
        if vertices[j].length >= SPIKE_SHARE * vertices[k].length:
            break
    return least, found


@subkernel
def kind_of_line(k, count, closed, vertices):
    """Return the kind of line k: CURVED_LINE on a round curve, SPIKE_LINE for a very short line, else STRAIGHT_LINE.

    count: number of lines of the path; closed: whether the path is closed; vertices: VERTEX rows, the starts of the
    lines.
    """
    line = vertices[k]
    if line.broken:
        return STRAIGHT_LINE
    if line.length < SPIKE:
        return SPIKE_LINE
    before, is_before = turn_beyond(k, -1, count, closed, vertices)
    after, is_after = turn_beyond(k, 1, count, closed, vertices)
    if not (is_before or is_after):
        return STRAIGHT_LINE
    most = max(abs(before), abs(after))
    if most > TURN:
        return STRAIGHT_LINE
    if not (is_before and is_after):
        return CURVED_LINE if line.length * most <= 4.0 * RISE and most > 0.0 else STRAIGHT_LINE
    if before * after <= 0.0 and line.length > DENT:
        return CURVED_LINE if line.length * most <= 8.0 * WAVE else STRAIGHT_LINE
    return CURVED_LINE if line.length * most <= 8.0 * RISE else STRAIGHT_LINE


@subkernel
def write_middles(path, workspace):
    """Write the middle of each pixel edge of a path to workspace.middles: the middle of edge k to row FIT + k.

    For a closed path, the last FIT edges are also written before the first, and the first FIT edges after the last.
    path: the Path; workspace: its runs and scratch arrays (Lines).
    """
    for k in range(path.count):
        run = workspace.runs[k]
        for step in range(run.length):
            middle = workspace.middles[run.at + step + FIT]
            middle.x = run.x + (step + 0.5) * right_of(run.direction)
            middle.y = run.y + (step + 0.5) * down_of(run.direction)
    if path.closed:
        for k in range(FIT):
            before, after = workspace.middles[k], workspace.middles[FIT + path.cracks + k]
            before.x = workspace.middles[FIT + (k - FIT) % path.cracks].x
            before.y = workspace.middles[FIT + (k - FIT) % path.cracks].y
            after.x = workspace.middles[FIT + k % path.cracks].x
            after.y = workspace.middles[FIT + k % path.cracks].y


@subkernel
def fit_at(row, half, middles, fitted_out):
    """Fit a parabola to the middles of the pixel edges in rows row - half to row + half.

    The parabola's point and direction at `row` are written to fitted_out, a FITTED row. If half is 0, 1 is used.
    middles: POINT rows, see write_middles.
    """
    half = half if half > 0 else 1
    whole = 3.0 * half * (half + 1) - 1.0
    share = 3.0 / ((2.0 * half - 1.0) * (2.0 * half + 1.0) * (2.0 * half + 3.0))
    x, y = whole * middles[row].x, whole * middles[row].y
    along_x = along_y = 0.0
    for k in range(1, half + 1):
        before, after = middles[row - k], middles[row + k]
        weight = whole - 5.0 * k * k
        x += weight * (before.x + after.x)
        y += weight * (before.y + after.y)
        along_x += k * (after.x - before.x)
        along_y += k * (after.y - before.y)
    size = math.sqrt(along_x * along_x + along_y * along_y)
    fitted_out.x, fitted_out.y = x * share, y * share
    fitted_out.along_x = along_x / size if size > 0.0 else 0.0
    fitted_out.along_y = along_y / size if size > 0.0 else 0.0


@subkernel
def fit_curve(curve, path, workspace):
    """Write the fitted point and direction (FITTED) at each pixel edge of a curve, and at the edge before its start.

    curve: Curve; path: the Path; workspace: its runs and scratch arrays (Lines).
    """
    first = math.floor(curve.start - 0.5)
    for crack in range(first, math.floor(curve.end - 0.5) + 2):
        half = math.floor(min(float(curve.half), crack + 0.5 - curve.low, curve.high - crack - 0.5))
        half = max(half, LEAST_FIT)
        if not path.closed:
            half = min(half, crack, path.cracks - 1 - crack)
        row = crack % path.cracks if path.closed else crack
        fit_at(row + FIT, half, workspace.middles, workspace.fitted[crack - first])


@subkernel
def fit_of(at, curve, fitted):
    """Return (x, y, along_x, along_y): point [px] and unit direction of a fitted curve at a position along its path.

    Both are interpolated between the two nearest pixel edges. at: position from the start of the path, in pixel edges;
    curve: Curve; fitted: FITTED rows of the curve, see fit_curve.
    """
    crack = math.floor(at - 0.5)
    share = at - 0.5 - crack
    a = fitted[crack - math.floor(curve.start - 0.5)]
    b = fitted[crack + 1 - math.floor(curve.start - 0.5)]
    along_x = a.along_x + share * (b.along_x - a.along_x)
    along_y = a.along_y + share * (b.along_y - a.along_y)
    size = math.sqrt(along_x * along_x + along_y * along_y)
    if size > 0.0:
        along_x /= size
        along_y /= size
    return a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), along_x, along_y


@subkernel
def off_corner(x, y, before, run, most):
    """Shorten an offset (x, y) [px] from the corner between two runs, so that its end is within `most` px of the runs.

    Return the new offset (x, y). A run is a straight row of pixel edges. before: RUN row that ends at the corner; run:
    RUN row that starts there.
    """
    x, y = min(max(x, -most), most), min(max(y, -most), most)
    ahead = x * right_of(run.direction) + y * down_of(run.direction)
    back = -x * right_of(before.direction) - y * down_of(before.direction)
    squared = x * x + y * y
    if ahead < 0.0 and back < 0.0 and squared > most * most:
        x *= most / math.sqrt(squared)
        y *= most / math.sqrt(squared)
    return x, y


@subkernel
def put_on_curve(n, k, along, curve, path, workspace):
    """Append a candidate corner (PLACE row) on run k of a path, moved onto the curve. Return the number of PLACE rows.

    A run is a straight row of pixel edges. Inside a run, the candidate is moved only along the run's normal. n: number
    of PLACE rows before; k: index of the run, which in a loop may exceed the number of runs; along: position from the
    start of the run, in pixel edges, 0 for the corner at which the run starts; path: the Path; workspace: its runs and
    scratch arrays (Lines).
    """
    runs = workspace.runs
    run = runs[k % path.count]
    right, down = right_of(run.direction), down_of(run.direction)
    at = run.at + along + k // path.count * path.cracks
    x, y = run.x + along * right, run.y + along * down
    fit_x, fit_y, along_x, along_y = fit_of(at, curve, workspace.fitted)
    off_x, off_y = fit_x - x, fit_y - y
    most = INSIDE * path.reach
    if along == 0.0:
        off_x, off_y = off_corner(off_x, off_y, runs[(k + path.count - 1) % path.count], run, most)
    else:
        ahead = along_x * right + along_y * down
        off = off_y * right - off_x * down
        if ahead > LEVEL:
            off -= (off_x * right + off_y * down) * (along_y * right - along_x * down) / ahead
        off = min(max(off, -most), most)
        off_x, off_y = -off * down, off * right
    x = min(max(math.floor((x + off_x) * GRAINS + 0.5) * GRAIN, path.low), path.high)
    y = min(max(math.floor((y + off_y) * GRAINS + 0.5) * GRAIN, path.low), path.high)
    put_place(n, x, y, at, run, False, True, workspace.places)
    workspace.places[n].along_x, workspace.places[n].along_y = along_x, along_y
    return n + 1


@subkernel
def put_vertex(n, vertex, at, k, curve, path, workspace):
    """Append a vertex as a candidate corner (PLACE row) on run k of a path. Return the number of PLACE rows.

    vertex: VERTEX row; n: number of PLACE rows before; at: position of the vertex along the path, in pixel edges;
    curve: Curve that gives the direction of the row; path: the Path; workspace: its runs and scratch arrays (Lines).
    """
    put_place(n, vertex.x, vertex.y, at, workspace.runs[k % path.count], False, True, workspace.places)
    place = workspace.places[n]
    _, _, place.along_x, place.along_y = fit_of(at, curve, workspace.fitted)
    return n + 1


@subkernel
def run_at(at, runs, path):
    """Return the index of the run (straight row of pixel edges) at a position along a path.

    at: the position, in pixel edges. In a loop it may exceed the loop's length; then the index exceeds the number of
    runs. runs: RUN rows; path: Path.
    """
    k = 0
    while runs[(k + 1) % path.count].at + (k + 1) // path.count * path.cracks <= at:
        k += 1
    return k


@subkernel
def put_curve(first, last, curve, path, workspace):
    """Write the candidate corners (PLACE rows) for the lines along a curve. Return the number of PLACE rows.

    first, last: indices of the vertices at the curve's ends; curve: Curve; path: the Path; workspace: its runs and
    scratch arrays (Lines).
    """
    runs, count = workspace.runs, path.count
    after = max(curve.start + APART, path.begin)
    before = min(curve.end - APART, path.end)
    k = run_at(curve.start, runs, path)
    n = put_vertex(0, workspace.vertices[first], curve.start, k, curve, path, workspace)
    while True:
        run = runs[k % count]
        begin = run.at + k // count * path.cracks
        if begin >= curve.end:
            break
        if begin > curve.start:
            put_place(n, float(run.x), float(run.y), float(begin), run, True, False, workspace.places)
            n += 1
            if after < begin < before:
                n = put_on_curve(n, k, 0.0, curve, path, workspace)
        steps = min(run.length - 1, 3)
        for step in range(steps):
            along = run.length * (step + 1.0) / (steps + 1.0)
            if after < begin + along < before:
                n = put_on_curve(n, k, along, curve, path, workspace)
        k += 1
    return put_vertex(n, workspace.vertices[last], curve.end, k - 1, curve, path, workspace)


@subkernel
def widest_fit(first, length, count, path, vertices):
    """Return the number of pixel edges, at most FIT, that a fit of a curve may use on either side of a point.

    It is small enough that directions within a fit differ by at most 2 FIT_TURN. first: index of the curve's first
    line; length: number of the curve's lines; count: number of lines of the path; vertices: VERTEX rows, the starts of
    the lines.
    """
    widest = 0.0
    for k in range(first, first + length):
        turned = least = most = 0.0
        start = vertices[k % count].at + k // count * path.cracks
        for m in range(k + 1, first + length):
            if vertices[m % count].at + m // count * path.cracks - start > 2 * FIT:
                break
            turned += turn_between(vertices[(m - 1) % count], vertices[m % count])
            least = min(least, turned)
            most = max(most, turned)
        widest = max(widest, most - least)
    return int(FIT * 2.0 * FIT_TURN / widest) if widest > 2.0 * FIT_TURN else FIT


@subkernel
def span_of(first, length, count, path, workspace):
    """Return the Curve that consists of `length` lines of a path, starting at vertex `first`.

    The Curve's field `half` is 0 if the curve is too narrow for a fit. count: number of lines of the path; path: the
    Path; workspace: its runs and scratch arrays (Lines).
    """
    vertices = workspace.vertices
    start = vertices[first].at
    last = first + length
    end = vertices[last].at if last <= count else vertices[last - count].at + path.cracks
    if path.closed and length == count and not vertices[first].anchor:
        # A closed curve without a fixed corner: the middle of a run is its start.
        k = run_at(start, workspace.runs, path)
        start = (
            workspace.runs[k % path.count].at
            + 0.5 * workspace.runs[k % path.count].length
            + k // path.count * path.cracks
        )
        end = start + path.cracks
    half = widest_fit(first, length, count, path, vertices)
    if half < NARROW_FIT:
        return Curve(start, end, start, end, 0)
    low, high = start, end
    if path.closed and length == count and not vertices[first].anchor:
        low, high = -math.inf, math.inf
    elif not path.closed:
        # An open path continues beyond the tile's border, so the fit may use cracks on the other side.
        low = 0.0 if first == 0 else low
        high = float(path.cracks) if last == count else high
        for k in range(path.count):
            if stays(workspace.runs, path.count, k, False):
                at = float(workspace.runs[k].at)
                low = max(low, at) if at <= start else low
                high = min(high, at) if at >= end else high
    return Curve(start, end, low, high, half)


@subkernel
def lay_curve(first, length, count, path, workspace, n, points_out):
    """Append the points of a curve to points_out, except its last point. Return the new number of points.

    No point is added if the curve is too narrow for a fit, or if no lines along it are found. first: index of the
    vertex at which the curve starts; length: number of lines of the path that the curve replaces; count: number of
    lines of the path; path: the Path; n: number of points before; points_out: POINT rows; workspace: scratch arrays
    (Lines).
    """
    curve = span_of(first, length, count, path, workspace)
    if curve.half == 0:
        return n
    fit_curve(curve, path, workspace)
    last = first + length if first + length <= count else first + length - count
    if curve.low < curve.start and path.closed:
        k = run_at(curve.start, workspace.runs, path)
        put_on_curve(0, k, 0.5 * workspace.runs[k % path.count].length, curve, path, workspace)
        for vertex in (first, last):
            workspace.vertices[vertex].x = workspace.places[0].x
            workspace.vertices[vertex].y = workspace.places[0].y
    places = put_curve(first, last, curve, path, workspace)
    found = cheapest(0, places - 1, path.reach, CURVE_PRICES, workspace.places, workspace.chain)
    for k in range(found - 1):
        place = workspace.places[workspace.chain[found - 1 - k]]
        points_out[n + k].x, points_out[n + k].y = place.x, place.y
        points_out[n + k].at = place.at
    return n + found - 1 if found > 0 else n


@subkernel
def put_points_of(first, length, vertices, n, points_out):
    """Append `length` vertices, starting with vertex `first`, to points_out. Return the new number of points.

    vertices: VERTEX rows; n: number of points before; points_out: POINT rows.
    """
    for k in range(first, first + length):
        points_out[n].x, points_out[n].y = vertices[k].x, vertices[k].y
        points_out[n].at = vertices[k].at
        n += 1
    return n


@subkernel
def lay_lines(found, path, workspace, n, points_out):
    """Append the points of the outline along a path: its straight lines, and lines recomputed along curves.

    Return the new number of points. For a closed path the last point, equal to the first, is omitted. found: number of
    entries of workspace.chain, which lists the ends of the straight lines; path: the Path; n: number of points before;
    points_out: POINT rows; workspace: scratch arrays (Lines).
    """
    vertices = workspace.vertices
    count = read_vertices(found, path, workspace)
    curved = 0
    begin = 0
    whole = path.closed
    for k in range(count):
        vertices[k].kind = kind_of_line(k, count, path.closed, vertices) if path.curves else STRAIGHT_LINE
        curved += 1 if vertices[k].kind == CURVED_LINE else 0
        if whole and (vertices[k].kind == STRAIGHT_LINE or vertices[k].anchor):
            begin = k
            whole = False
    if curved > 1:
        write_middles(path, workspace)
    k = 0
    while k < count:
        first = (begin + k) % count
        length = 0
        curved = 0
        steepest = 0.0
        while k + length < count:
            line = vertices[(first + length) % count]
            if line.kind == STRAIGHT_LINE or (length > 0 and line.anchor):
                break
            if length > 0:
                steepest = max(steepest, abs(turn_between(vertices[(first + length - 1) % count], line)))
            curved += 1 if line.kind == CURVED_LINE and line.length >= CLEAR else 0
            length += 1
        laid = n
        if curved > 1 and steepest > GENTLE:
            laid = lay_curve(first, length, count, path, workspace, n, points_out)
        if laid == n:
            length = max(length, 1)
            within = min(length, count - first)
            laid = put_points_of(first, within, vertices, n, points_out)
            laid = put_points_of(0, length - within, vertices, laid, points_out)
        n = laid
        k += length
    return n if path.closed else put_points_of(count, 1, vertices, n, points_out)


@kernel
def lines_of_loop(path, workspace, points_out):
    """Write the points of the outline along a closed path. Return the number of points; 0 if no lines were found.

    path: the Path; workspace: the path's runs and scratch arrays (Lines); points_out: POINT rows.
    """
    around, anchor = put_loop(workspace.runs, path.count, path.cracks, workspace.places)
    found = cheapest_loop(around, anchor, path.reach, workspace.places, workspace.chain)
    return lay_lines(found, path, workspace, 0, points_out) if found > 0 else 0
