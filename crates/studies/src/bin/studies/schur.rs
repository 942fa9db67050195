//! Roots of polynomials by the companion matrix, ours and nalgebra's Schur decomposition of it.

use super::turns::in_turns;
use continuum_testing::Random;
use nalgebra::allocator::Allocator;
use nalgebra::linalg::{Schur, balancing::balance_parlett_reinsch};
use nalgebra::{Const, DefaultAllocator, DimDiff, DimSub, SMatrix, U1};
use parry_continuum::distance::DoubleDouble;
use real_polynomial_roots::{Companion, RootFinder, RootsError};
use std::fmt::Write;
use std::hint::black_box;

/// The routes take turns with this many parts of the polynomials.
const TURNS: usize = 20;
const ROUTES: [&str; 3] = ["ours", "nalgebra", "nalgebra, balanced"];
const KINDS: [&str; 2] = ["in [-100, 100]", "1e-6 to 1e6"];
/// Iterations after which nalgebra gives up: far more than a convergent run needs.
const PATIENCE: usize = 10_000;
/// Of a root that solves its polynomial to rounding, in units of u.
const SOLVED: f64 = 100.0;

/// What a route does with the polynomials of one degree.
#[derive(Clone, Copy, Default)]
struct Outcome {
    /// Microseconds for one polynomial.
    time: f64,
    /// The share of the roots that solve their polynomial to rounding.
    solved: f64,
    /// The largest backward error of a root, in units of u.
    worst: f64,
}

/// A root, its real part first.
type Root = [f64; 2];

/// The least relative change of the coefficients that makes `root` exact: |p(z)| / sum |p_k| |z|^k,
/// in units of u.
fn backward_error(coefficients: &[f64], root: Root) -> f64 {
    let [re, im] = root.map(DoubleDouble::from);
    let size = root[0].hypot(root[1]);
    let (mut value, mut scale) = ([DoubleDouble::ZERO; 2], 0.0);
    for &coefficient in coefficients.iter().rev() {
        let [x, y] = value;
        value = [x * re - y * im + coefficient.into(), x * im + y * re];
        scale = scale * size + coefficient.abs();
    }
    value[0].rounded().hypot(value[1].rounded()) / scale / (0.5 * f64::EPSILON)
}

fn by_ours<const M: usize>(coefficients: &[f64; M]) -> Vec<Root> {
    match Companion::roots(*coefficients) {
        Ok(roots) | Err(RootsError::NotConverged { found: roots }) => {
            roots.iter().map(|root| [root.re, root.im]).collect()
        }
        Err(_) => Vec::new(),
    }
}

fn by_nalgebra<const M: usize, const N: usize>(
    coefficients: &[f64; M],
    is_balanced: bool,
) -> Vec<Root>
where
    Const<N>: DimSub<U1>,
    DefaultAllocator: Allocator<Const<N>, DimDiff<Const<N>, U1>> + Allocator<DimDiff<Const<N>, U1>>,
{
    let lead = coefficients[N];
    let mut companion = SMatrix::<f64, N, N>::from_fn(|row, column| {
        let below = if row == column + 1 { 1.0 } else { 0.0 };
        if column == N - 1 { -coefficients[row] / lead } else { below }
    });
    if is_balanced {
        balance_parlett_reinsch::<f64, Const<N>>(&mut companion);
    }
    let schur = Schur::<f64, Const<N>>::try_new(companion, f64::EPSILON, PATIENCE);
    schur.map_or_else(Vec::new, |schur| {
        schur.complex_eigenvalues().iter().map(|root| [root.re, root.im]).collect()
    })
}

/// From the coefficients of a polynomial to its roots.
type Route<const M: usize> = fn(&[f64; M]) -> Vec<Root>;

/// All routes on polynomials of degree N = M - 1.
fn outcomes<const M: usize, const N: usize>(count: usize, kind: usize) -> [Outcome; 3]
where
    Const<N>: DimSub<U1>,
    DefaultAllocator: Allocator<Const<N>, DimDiff<Const<N>, U1>> + Allocator<DimDiff<Const<N>, U1>>,
{
    let mut random = Random::new(M as u64);
    let mut coefficient = || match kind {
        0 => random.between(-100.0, 100.0),
        _ => 10.0_f64.powf(random.between(-6.0, 6.0)) * [1.0, -1.0][random.below(2) as usize],
    };
    let polynomials: Vec<[f64; M]> =
        (0..count).map(|_| std::array::from_fn(|_| coefficient())).collect();
    let routes: [Route<M>; 3] = [
        by_ours::<M>,
        |coefficients| by_nalgebra::<M, N>(coefficients, false),
        |coefficients| by_nalgebra::<M, N>(coefficients, true),
    ];
    let part = count.div_ceil(TURNS);
    let piece = |turn: usize| polynomials.chunks(part).nth(turn).unwrap_or_default();
    let run = |route: usize, turn: usize| {
        piece(turn).iter().for_each(|one| _ = black_box(routes[route](one)))
    };
    let times = in_turns(
        TURNS,
        [&mut |turn| run(0, turn), &mut |turn| run(1, turn), &mut |turn| run(2, turn)],
    );
    std::array::from_fn(|route| {
        let mut outcome = Outcome { time: times[route] * 1e6 / part as f64, ..Outcome::default() };
        for coefficients in &polynomials {
            for root in routes[route](coefficients) {
                let error = backward_error(coefficients, root);
                outcome.solved += f64::from(u8::from(error <= SOLVED));
                outcome.worst = outcome.worst.max(error);
            }
        }
        outcome.solved /= (count * N) as f64;
        outcome
    })
}

/// The chapter of the page.
pub fn chapter(count: usize) -> Result<String, String> {
    let both = |degree: usize, kind: usize| match degree {
        3 => outcomes::<4, 3>(count, kind),
        4 => outcomes::<5, 4>(count, kind),
        6 => outcomes::<7, 6>(count, kind),
        10 => outcomes::<11, 10>(count, kind),
        _ => outcomes::<16, 15>(count, kind),
    };
    let measured: Vec<_> = [0, 1]
        .into_iter()
        .flat_map(|kind| [3, 4, 6, 10, 15].map(|degree| (kind, degree, both(degree, kind))))
        .collect();
    write_page(count, &measured).map_err(|error| error.to_string())
}

fn write_page(
    count: usize,
    measured: &[(usize, usize, [Outcome; 3])],
) -> Result<String, std::fmt::Error> {
    let mut page = format!(
        "## The companion matrix, ours and nalgebra's\n\n\
         The eigenvalues of the companion matrix of {count} random polynomials of each degree in f64: by `real-polynomial-roots`, and by \
         nalgebra's real Schur decomposition, of the matrix as it is and balanced by nalgebra before. Coefficients are uniform in [-100, 100], or \
         of a magnitude from 1e-6 to 1e6 and either sign. Microseconds a polynomial on one thread (from the median of {TURNS} parts), each route \
         with a vector for its roots. Solved: the share of the roots that are exact for coefficients changed by at most \
         {SOLVED:.0} u of themselves. Worst: the largest such change, in u, of any root that was returned.\n\n\
         | coefficients | degree | ours us | solved | worst | nalgebra us | solved | worst | balanced us | solved | worst |\n\
         |---|---|---|---|---|---|---|---|---|---|---|\n"
    );
    for (kind, degree, routes) in measured {
        write!(page, "| {} | {degree} |", KINDS[*kind])?;
        for Outcome { time, solved, worst } in routes {
            write!(page, " {time:.2} | {} | {worst:.2e} |", super::polynomials::percent(*solved))?;
        }
        writeln!(page)?;
    }
    let least = |route: usize| {
        let ratios = measured.iter().map(|(.., routes)| routes[route].time / routes[0].time);
        ratios.clone().fold(f64::INFINITY, f64::min)..ratios.fold(0.0, f64::max)
    };
    page.push_str("\nFindings:");
    for (route, name) in ROUTES.iter().enumerate().skip(1) {
        let ratios = least(route);
        write!(
            page,
            " {name} takes {:.1} to {:.1} times as long as ours.",
            ratios.start, ratios.end
        )?;
    }
    page.push_str(
        " Ours adds to the eigenvalues what they lack: the test of each root, scaling by powers of two, single precision, and \
         the same text on the GPU.\n",
    );
    Ok(page)
}
