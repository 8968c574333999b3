"""Pairwise covering arrays: few cases that contain every combination of two values of different parameters.

They reveal each defect that depends on one or two parameters. Defects that depend on three need the full product.
Method: greedy, each case covers as many new pairs as possible (Cohen, Dalal, Fredman and Patton, The AETG System, IEEE
Transactions on Software Engineering 23, 1997). Ties go to the first value, so that the cases are always the same.
"""

from itertools import combinations, product


def pairwise(*parameters):
    """Return tuples with one value of each parameter that together contain all pairs of values, in the order of the
    product.
    """
    values = [tuple(each) for each in parameters]
    places = range(len(values))
    missing = {
        ((a, one), (b, other))
        for a, b in combinations(places, 2)
        for one in range(len(values[a]))
        for other in range(len(values[b]))
    }
    cases = []
    while missing:
        case = dict(min(missing))  # a pair that is still missing, then the value that covers most for each place
        for place in sorted(set(places) - set(case), key=lambda place: -len(values[place])):
            case[place] = max(
                range(len(values[place])),
                key=lambda value: sum(tuple(sorted(((place, value), pair))) in missing for pair in case.items()),
            )
        missing -= set(combinations(sorted(case.items()), 2))
        cases.append(tuple(case[place] for place in places))
    if len(values) == 1:
        cases = [(k,) for k in range(len(values[0]))]
    return [tuple(values[place][case[place]] for place in places) for case in sorted(cases)]


def the_others(*parameters):
    """Return the cases of the full product that `pairwise` leaves out, in the order of the product."""
    taken = set(pairwise(*(range(len(each)) for each in parameters)))
    values = [tuple(each) for each in parameters]
    cases = product(*(range(len(each)) for each in values))
    return [tuple(values[k][case[k]] for k in range(len(case))) for case in cases if case not in taken]
