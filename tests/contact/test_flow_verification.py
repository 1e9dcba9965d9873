"""Exact propagation of linear systems, its roots and its integrals, against scipy's expm and closed forms.

All of it in Python, and once more in the compiled kernel where it is built.
"""

from itertools import islice

import numpy as np
import pytest
import scipy.linalg as la
from scipy.integrate import quad

from cuefem.contact.flow import CELLS, DEGREE, Drive, Flow, Guards, exponential, integral_of_product, march, zero
from cuefem.contact.kernel import VARIABLE
from tests.helpers.kernels import KERNELS

RNG = np.random.default_rng(7)


@pytest.fixture(autouse=True, params=KERNELS)
def kernel(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(VARIABLE, request.param)


def system(kind: str, n: int = 12) -> np.ndarray:
    """Matrices of norm 1 of every kind a contact's phases can have."""
    raw = RNG.normal(size=(n, n))
    if kind == "turning":
        raw = raw - raw.T
    if kind == "defective":
        raw = np.diag(np.ones(n - 1), 1)
    if kind == "growing":
        raw = raw + 3 * np.eye(n)
    return raw / np.linalg.norm(raw, 2)


def oscillator(omega: float = 1.0, *, rows: list[list[float]], phase: float = 0.0) -> tuple[Flow, np.ndarray]:
    """z = (sin, cos)(omega t + phase, as a constant third component is kept) and outputs of it."""
    A = np.zeros((3, 3))
    A[0, 1], A[1, 0] = omega, -omega
    drive = Drive(np.array([omega]), slice(1, 2), np.zeros((0, 3)), np.zeros((0, 3)))
    return Flow(A, np.array(rows, float), omega, drive), np.array([np.sin(phase), np.cos(phase), 1.0])


def pushing(A: np.ndarray) -> Drive:
    """A motion without oscillators: one push a state."""
    return Drive(np.zeros(0), slice(0, 0), A, np.eye(len(A)))


def only(weights: list[list[float]], constants: list[float]) -> Guards:
    return Guards(np.array(weights, float), np.array(constants, float))


@pytest.mark.parametrize("kind", ["turning", "any", "defective", "growing"])
@pytest.mark.parametrize("norm", [1.0, 0.3, 1e-3, 0.0])
def test_exponential_is_scipy_s(kind, norm):
    X = system(kind) * norm
    assert np.abs(exponential(X) - la.expm(X)).max() < 4e-15 * np.exp(norm)


@pytest.mark.parametrize("kind", ["turning", "any", "defective", "growing"])
def test_states_and_outputs_are_those_of_the_exponential(kind):
    A, rows = system(kind) * 40.0, RNG.normal(size=(3, 12))
    flow = Flow(A, rows, 40.0)
    z = RNG.normal(size=12)
    states, polynomials = (np.concatenate(parts, axis=-1) for parts in zip(*islice(flow.blocks(z), 3), strict=True))
    assert states.shape == (12, 1 + 2 * CELLS)
    for cell in (0, 1, 7, 31):
        exact = la.expm(A * flow.step * cell) @ z
        assert np.abs(states[:, cell] - exact).max() < 1e-13 * (1 + cell) * np.abs(exact).max()
    assert polynomials.shape == (3, DEGREE + 1, 1 + 2 * CELLS)
    for fraction in (0.0, 0.15, 0.5, 1.0):
        exact = rows @ la.expm(A * flow.step * (1 + fraction)) @ z
        powers = fraction ** np.arange(DEGREE + 1)
        assert np.abs(polynomials[:, :, 1] @ powers - exact).max() < 1e-13 * np.abs(exact).max()
        assert np.abs(rows @ flow.state(states[:, 1], fraction) - exact).max() < 1e-13 * np.abs(exact).max()


@pytest.mark.parametrize("periods", [0.01, 0.3, 5.0, 40.0])
def test_the_first_root_is_found_far_and_near(periods):
    """1.001 - t/(2 pi periods): a guard without oscillation, its root in any cell of any block."""
    A = np.array([[0.0, 1.0], [0.0, 0.0]])
    end = 2 * np.pi * periods
    arrival = march(
        Flow(A, np.eye(2), 1.0, pushing(A)), np.array([0.0, 1.0]), only([[-1.0, 0]], [end]), start=0.0, limit=1e9
    )
    assert arrival is not None
    assert abs(arrival.time - end) < 1e-13 * end
    assert abs(arrival.state[0] - end) < 1e-12 * end
    assert abs(arrival.pieces[-1].end - end) < 1e-12 * end


@pytest.mark.parametrize("phase", [0.0, 1.0, 3.0])
def test_a_root_of_a_sine_is_where_it_is(phase):
    flow, z = oscillator(1000.0, rows=np.eye(3).tolist(), phase=phase)
    arrival = march(flow, z, only([[1, 0, 0]], [0.0]), start=2.0, limit=3.0)
    assert arrival is not None
    assert abs(arrival.time - 2 - (np.pi - phase) / 1000) < 1e-15
    assert abs(arrival.state[0]) < 1e-13


def test_the_earliest_of_two_guards_in_one_cell_ends_the_phase():
    flow, z = oscillator(rows=np.eye(3).tolist())
    guards = only([[-1, 0, 0], [-1, 0, 0], [0, 1, 0]], [0.5001, 0.5, 0.0])
    arrival = march(flow, z, guards, start=0.0, limit=10.0)
    assert arrival is not None
    assert arrival.guard == 1
    assert abs(arrival.time - np.pi / 6) < 1e-14


@pytest.mark.parametrize("excess", [-1e-3, -1e-9, 1e-9, 1e-6, 1e-3])
def test_a_grazing_dip_between_samples_ends_a_phase(excess):
    """1 - excess + cos t dips below zero for a positive excess only, and between two samples: for sqrt(8 excess)."""
    flow, _ = oscillator(rows=np.eye(3).tolist())
    for phase in np.linspace(0, 1, 23):
        z = np.array([np.sin(phase), np.cos(phase), 1.0])
        arrival = march(flow, z, only([[0, 1, 0]], [1 - excess]), start=0.0, limit=32.0)
        if excess < 0:
            assert arrival is None
        else:
            assert arrival is not None
            # the root of a parabola loses half the digits
            assert abs(arrival.time - (np.arccos(excess - 1) - phase)) < 1e-15 / np.sqrt(2 * excess)


def test_a_guard_that_starts_at_zero_may_rise_first():
    """v_t is zero when slip starts, F_n when the contact starts: no event at the start, but at the next zero."""
    flow, z = oscillator(rows=np.eye(3).tolist())
    arrival = march(flow, z, only([[1, 0, 0]], [0.0]), start=0.0, limit=10.0)
    assert arrival is not None
    assert abs(arrival.time - np.pi) < 1e-14


@pytest.mark.parametrize("rounding", [-1e-16, 1e-16])
def test_a_guard_that_starts_at_zero_but_for_rounding_may_rise_first(rounding):
    flow, z = oscillator(rows=np.eye(3).tolist())
    arrival = march(flow, z, only([[1, 0, 0]], [rounding]), start=0.0, limit=10.0)
    assert arrival is not None
    assert abs(arrival.time - np.pi) < 1e-14


def test_a_guard_that_starts_at_zero_and_rises_and_falls_in_one_cell():
    """t - 40 t^2 on a cell of length 1: back at zero at 0.025, before the first sample."""
    A = np.zeros((3, 3))
    A[0, 1] = A[1, 2] = 1.0
    flow = Flow(A, np.eye(3), 1.0, pushing(A))
    arrival = march(flow, np.array([0.0, 1.0, -80.0]), only([[1, 0, 0]], [0.0]), start=0.0, limit=10.0)
    assert arrival is not None
    assert abs(arrival.time - 0.025) < 1e-14


@pytest.mark.parametrize("start", [0.0, -1e-3])
def test_a_guard_that_falls_from_the_start_ends_the_phase_at_once(start):
    flow, z = oscillator(rows=np.eye(3).tolist())
    arrival = march(flow, z, only([[-1, 0, 0]], [start]), start=1.0, limit=10.0)
    assert arrival is not None
    assert arrival.time == 1.0
    assert not arrival.pieces
    assert np.array_equal(arrival.state, z)


def test_no_root_by_the_limit_is_none():
    flow, z = oscillator(rows=np.eye(3).tolist())
    assert march(flow, z, only([[1, 0, 0]], [1.5]), start=0.0, limit=200.0) is None


def test_integral_of_a_product_is_quad_s():
    flow, z = oscillator(50.0, rows=np.eye(3).tolist(), phase=0.3)
    arrival = march(flow, z, only([[1, 0, 0]], [0.0]), start=0.0, limit=1.0)
    assert arrival is not None
    for first, second in ((0, 0), (0, 1), (1, 2)):
        found = sum(integral_of_product(piece, first, second) for piece in arrival.pieces)
        terms = [lambda t: np.sin(50 * t + 0.3), lambda t: np.cos(50 * t + 0.3), lambda t: 1.0]
        exact = quad(lambda t, f=terms[first], g=terms[second]: f(t) * g(t), 0, arrival.time, epsabs=1e-15)[0]
        assert abs(found - exact) < 1e-15


@pytest.mark.parametrize("root", [1e-9, 0.1234, 0.5, 0.999])
@pytest.mark.parametrize(
    ("function", "width"),
    [
        (lambda x, r: (x - r) * (1 + x * x), 1e-15),
        (lambda x, r: np.tanh(50 * (r - x)), 1e-15),
        (lambda x, r: np.exp(5 * x) - np.exp(5 * r), 4e-15),
        (lambda x, r: (x - r) ** 9, 4e-15),
        (lambda x, r: 1.0 if x > r else -1.0, 4e-15),
    ],
)
def test_a_zero_is_found_however_flat_or_steep(function, width, root):
    calls = []

    def counted(x: float) -> float:
        calls.append(x)
        return float(function(x, root))

    assert abs(zero(counted, 0.0, 1.0) - root) < width
    assert len(calls) < 120
