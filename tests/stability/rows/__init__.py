"""All hard cases of the stability suite by section, with limits and sources; used by the tests
and docs/stability.md.
"""

from tests.stability.rows.a_broad_phase import BROAD_PHASE
from tests.stability.rows.b_primitives import PRIMITIVES
from tests.stability.rows.c_distance import DISTANCE
from tests.stability.rows.d_masks import MASKS
from tests.stability.rows.e_ground import GROUND
from tests.stability.rows.f_contacts import CONTACTS
from tests.stability.rows.g_continuous import CONTINUOUS
from tests.stability.rows.h_queries import QUERIES
from tests.stability.rows.i_mass import MASS
from tests.stability.rows.j_far_away import FAR_AWAY
from tests.stability.rows.k_bad_input import BAD_INPUT
from tests.stability.rows.l_time import TIME
from tests.stability.rows.m_effects import EFFECTS
from tests.stability.rows.n_joints import JOINTS
from tests.stability.rows.row import Limit, Row, Section

__all__ = ["ROWS", "SECTIONS", "Limit", "Row", "Section"]

SECTIONS = (
    BROAD_PHASE,
    PRIMITIVES,
    DISTANCE,
    MASKS,
    GROUND,
    CONTACTS,
    CONTINUOUS,
    QUERIES,
    MASS,
    FAR_AWAY,
    BAD_INPUT,
    TIME,
    EFFECTS,
    JOINTS,
)
ROWS = {row.id: row for section in SECTIONS for row in section.rows}
