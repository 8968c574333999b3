"""What began, went on, ended and hit in the last step: arrays, read after the step, valid until the next one."""

import numpy as np

from physics.jit import kernel, subkernel
from physics.tables.contact import EVENT, HIT, QUARANTINE


@subkernel
def write_event(contact, at, events_out):
    """Copy what an event tells of a contact."""
    e = events_out[at]
    e.body_a = contact.body_a
    e.body_b = contact.body_b
    e.shape_a = contact.shape_a
    e.shape_b = contact.shape_b
    e.point_x = contact.point_x
    e.point_y = contact.point_y
    e.normal_x = contact.normal_x
    e.normal_y = contact.normal_y


@subkernel
def copy_event(events, source, target, events_out):
    """Copy an event row."""
    s = events[source]
    d = events_out[target]
    d.body_a = s.body_a
    d.body_b = s.body_b
    d.shape_a = s.shape_a
    d.shape_b = s.shape_b
    d.point_x = s.point_x
    d.point_y = s.point_y
    d.normal_x = s.normal_x
    d.normal_y = s.normal_y


@kernel
def compare_pairs(
    # read
    before,
    contacts,
    parked,
    sensors,
    slop,
    hit_speed,
    # write
    now_out,
    begin_out,
    persist_out,
    end_out,
    hits_out,
    keep_out,
    counts_out,
):
    """Compare the pairs that touched before with the contacts of this step, both in the order of shape ids.

    before EVENT rows; contacts CONTACT rows; parked CONTACT rows of pairs that sleep: they go on touching and say
    nothing; sensors: 1 to look at contacts of sensors only, 0 at the others only;
    slop [px]: a pair that touched goes on touching up to it; hit_speed [px/s]. now_out: the pairs that touch; keep_out
    (contacts) bool: contacts of such pairs; counts_out: rows written to now, begin, persist, end, hits. O(both).
    """
    touching = 0
    begun = 0
    persisted = 0
    ended = 0
    hits = 0
    i = 0
    j = 0
    asleep = 0
    while i < len(before) or j < len(contacts):
        if j < len(contacts) and contacts[j].sensor != (sensors == 1):
            j += 1
            continue
        # The group of contacts of one pair, if it comes no later than the next pair that touched before.
        old = False
        new = False
        if j >= len(contacts):
            old = True
        elif i >= len(before):
            new = True
        else:
            p = before[i]
            c = contacts[j]
            old = p.shape_a < c.shape_a or (p.shape_a == c.shape_a and p.shape_b <= c.shape_b)
            new = not old or (p.shape_a == c.shape_a and p.shape_b == c.shape_b)
        if not new:
            p = before[i]
            while asleep < len(parked) and (
                parked[asleep].shape_a < p.shape_a
                or (parked[asleep].shape_a == p.shape_a and parked[asleep].shape_b < p.shape_b)
            ):
                asleep += 1
            if asleep < len(parked) and parked[asleep].shape_a == p.shape_a and parked[asleep].shape_b == p.shape_b:
                copy_event(before, i, touching, now_out)
                touching += 1
            else:
                copy_event(before, i, ended, end_out)
                ended += 1
            i += 1
            continue
        c = contacts[j]
        last = j
        active = False
        acted = False
        deepest = j
        fastest = j
        while last < len(contacts) and contacts[last].shape_a == c.shape_a and contacts[last].shape_b == c.shape_b:
            k = contacts[last]
            if k.separation <= 0.0 or k.normal_impulse > 0.0 or k.swept or (old and k.separation <= slop):
                active = True
            if k.normal_impulse > 0.0:
                acted = True
            if k.separation < contacts[deepest].separation:
                deepest = last
            if k.speed > contacts[fastest].speed:
                fastest = last
            last += 1
        if active:
            write_event(contacts[deepest], touching, now_out)
            touching += 1
            if old:
                write_event(contacts[deepest], persisted, persist_out)
                persisted += 1
            else:
                write_event(contacts[deepest], begun, begin_out)
                begun += 1
            if (acted or not old) and contacts[fastest].speed > hit_speed:
                write_event(contacts[fastest], hits, hits_out)
                total = 0.0
                for k in range(j, last):
                    total += contacts[k].normal_impulse
                hits_out[hits].speed = contacts[fastest].speed
                hits_out[hits].normal_impulse = total
                hits += 1
        elif old:
            copy_event(before, i, ended, end_out)
            ended += 1
        for k in range(j, last):
            keep_out[k] = active
        if old:
            i += 1
        j = last
    counts_out[0] = touching
    counts_out[1] = begun
    counts_out[2] = persisted
    counts_out[3] = ended
    counts_out[4] = hits


class Pairs:
    """The pairs that touch, and what changed among them in the last step."""

    def __init__(self):
        self.count = 0
        self.tables = [np.zeros(16, dtype) for dtype in (EVENT, EVENT, EVENT, EVENT, HIT)]
        self.before = np.zeros(16, EVENT)
        self.keep = np.zeros(16, np.bool_)
        self.counts = np.zeros(5, np.int64)

    def compare(self, contacts, parked, sensors: bool, slop: float, hit_speed: float):
        """Take in the contacts of a step. Returns (begin, persist, end, hits, keep)."""
        room = self.count + len(contacts)
        if room > len(self.keep):
            self.tables = [np.zeros(2 * room, each.dtype) for each in self.tables]
            before = np.zeros(2 * room, EVENT)
            before[: self.count] = self.before[: self.count]
            self.before, self.keep = before, np.zeros(2 * room, np.bool_)
        compare_pairs(
            self.before[: self.count],
            contacts,
            parked,
            int(sensors),
            slop,
            hit_speed,
            *self.tables,
            self.keep,
            self.counts,
        )
        now, *changes = (table[:count] for table, count in zip(self.tables, self.counts.tolist()))
        self.count = len(now)
        # What touches now is what touched before, next time: the two tables change places.
        self.tables[0], self.before = self.before, self.tables[0]
        return *changes, self.keep[: len(contacts)]

    def restore(self, touching):
        """Set the pairs that touch."""
        self.__init__()
        self.count = len(touching)
        self.before = np.zeros(max(16, self.count), EVENT)
        self.before[: self.count] = touching
        self.keep = np.zeros(0, np.bool_)  # grown, with all tables, by the next comparison


class Events:
    """Structured arrays of the last step; see api.md for their columns."""

    def __init__(self):
        self.begin = self.persist = self.end = self.sensor_begin = self.sensor_end = np.zeros(0, EVENT)
        self.hits = np.zeros(0, HIT)
        self.quarantined = np.zeros(0, QUARANTINE)
