"""All touching pairs of closed boxes, by a double loop."""


def touching_pairs(lower, upper):
    """Return [(a, b), ...] with a < b, sorted, of the boxes that touch. lower, upper: corners; equal borders touch."""
    found = []
    for a in range(len(lower)):
        for b in range(a + 1, len(lower)):
            if all(lower[a][k] <= upper[b][k] and lower[b][k] <= upper[a][k] for k in (0, 1)):
                found.append((a, b))
    return found


def agree(a, b):
    """Return whether two (membership, mask) filters accept each other."""
    return bool(a[0] & b[1]) and bool(b[0] & a[1])
