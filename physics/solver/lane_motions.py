"""How lanes see motions: what is gathered from the MOTION rows of a block, the separations, and the way back."""

from physics.jit import inlined
from physics.solver import lanes as at


@inlined
def gather_speeds(a, b, lane, s_out):
    """Bring the velocities of MOTION rows into a lane."""
    s_out[at.VX_A + lane] = a.vx
    s_out[at.VY_A + lane] = a.vy
    s_out[at.W_A + lane] = a.angular_velocity
    s_out[at.VX_B + lane] = b.vx
    s_out[at.VY_B + lane] = b.vy
    s_out[at.W_B + lane] = b.angular_velocity


@inlined
def gather_poses(a, b, lane, s_out):
    """Bring into a lane how far MOTION rows went since the step began."""
    s_out[at.DX_A + lane] = a.dx
    s_out[at.DY_A + lane] = a.dy
    s_out[at.COS_A + lane] = a.cosine
    s_out[at.SIN_A + lane] = a.sine
    s_out[at.DX_B + lane] = b.dx
    s_out[at.DY_B + lane] = b.dy
    s_out[at.COS_B + lane] = b.cosine
    s_out[at.SIN_B + lane] = b.sine


@inlined
def scatter_speeds(s, lane, a_out, b_out):
    """Write the velocities of a lane back to its MOTION rows."""
    a_out.vx = s[at.VX_A + lane]
    a_out.vy = s[at.VY_A + lane]
    a_out.angular_velocity = s[at.W_A + lane]
    b_out.vx = s[at.VX_B + lane]
    b_out.vy = s[at.VY_B + lane]
    b_out.angular_velocity = s[at.W_B + lane]


@inlined
def measure_gaps(lane, s, c_inout):
    """Write the separations [px] at both points of a lane.

    A round surface stays where it is when its body turns: cores are what moves. Arms turn with their bodies here, and
    stay where speeds are measured.
    """
    c = c_inout
    nx = c[at.NX + lane]
    ny = c[at.NY + lane]
    cos_a = s[at.COS_A + lane]
    sin_a = s[at.SIN_A + lane]
    cos_b = s[at.COS_B + lane]
    sin_b = s[at.SIN_B + lane]
    core = c[at.RADIUS_A + lane] * cos_a + c[at.RADIUS_B + lane] * cos_b
    gap = core + (s[at.DX_B + lane] - s[at.DX_A + lane]) * nx + (s[at.DY_B + lane] - s[at.DY_A + lane]) * ny
    x = (cos_b * c[at.BX_1 + lane] - sin_b * c[at.BY_1 + lane]) - (
        cos_a * c[at.AX_1 + lane] - sin_a * c[at.AY_1 + lane]
    )
    y = (sin_b * c[at.BX_1 + lane] + cos_b * c[at.BY_1 + lane]) - (
        sin_a * c[at.AX_1 + lane] + cos_a * c[at.AY_1 + lane]
    )
    c[at.GAP_1 + lane] = gap + c[at.BASE_1 + lane] + (x * nx + y * ny)
    x = (cos_b * c[at.BX_2 + lane] - sin_b * c[at.BY_2 + lane]) - (
        cos_a * c[at.AX_2 + lane] - sin_a * c[at.AY_2 + lane]
    )
    y = (sin_b * c[at.BX_2 + lane] + cos_b * c[at.BY_2 + lane]) - (
        sin_a * c[at.AX_2 + lane] + cos_a * c[at.AY_2 + lane]
    )
    c[at.GAP_2 + lane] = gap + c[at.BASE_2 + lane] + (x * nx + y * ny)


@inlined
def levers_of(c, lane):
    """How the arms of both points turn an impulse along the normal: a_1, b_1, a_2, b_2 [px]."""
    nx = c[at.NX + lane]
    ny = c[at.NY + lane]
    return (
        c[at.AX_1 + lane] * ny - c[at.AY_1 + lane] * nx,
        c[at.BX_1 + lane] * ny - c[at.BY_1 + lane] * nx,
        c[at.AX_2 + lane] * ny - c[at.AY_2 + lane] * nx,
        c[at.BX_2 + lane] * ny - c[at.BY_2 + lane] * nx,
    )
