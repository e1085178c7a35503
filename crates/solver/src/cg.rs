//! Preconditioned conjugate gradients with a budget.
//!
//! Source: Hestenes, Stiefel 1952; preconditioned form as in Golub, Van Loan, 11.5. Started from zero, every iterate
//! `x` has `x·b > 0`: with `b = -g/2` each is a descent direction, however small the budget. The residual is
//! measured in the preconditioner's norm, `sqrt(r·P⁻¹r)` relative to the right-hand side: that follows the error in
//! the energy norm, where the Euclidean norm of a fourth-order operator sees ripples only.

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limit {
    pub(crate) iterations: u32,
    pub(crate) tolerance: f64,
}

/// How far it came.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Outcome {
    pub(crate) iterations: u32,
    /// Relative residual in the preconditioner's norm; 0 when the right-hand side is zero.
    pub(crate) residual: f64,
    /// `b·P⁻¹b`, to which the residual is relative.
    pub(crate) reference: f64,
}

/// Vectors kept between solves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    r: Vec<f64>,
    z: Vec<f64>,
    p: Vec<f64>,
    q: Vec<f64>,
}

/// Improves `x` towards `A x = b`; `x` comes in as the first guess.
pub(crate) fn solve(
    apply: impl FnMut(&[f64], &mut [f64]),
    precondition: impl FnMut(&[f64], &mut [f64]),
    b: &[f64],
    x: &mut [f64],
    limit: Limit,
    workspace: &mut Workspace,
) -> Outcome {
    solve_again(apply, precondition, b, x, limit, None, workspace)
}

/// The same where `b·P⁻¹b` is known well enough from a like right-hand side, which saves an application of `P⁻¹`.
pub(crate) fn solve_again(
    mut apply: impl FnMut(&[f64], &mut [f64]),
    mut precondition: impl FnMut(&[f64], &mut [f64]),
    b: &[f64],
    x: &mut [f64],
    limit: Limit,
    reference: Option<f64>,
    workspace: &mut Workspace,
) -> Outcome {
    let Workspace { r, z, p, q } = workspace;
    for vector in [&mut *r, &mut *z, &mut *p, &mut *q] {
        vector.clear();
        vector.resize(b.len(), 0.0);
    }
    r.copy_from_slice(b);
    let has_guess = x.iter().any(|&value| value != 0.0);
    let reference = reference.filter(|_| has_guess).unwrap_or_else(|| {
        precondition(b, z);
        dot(b, z)
    });
    if has_guess {
        apply(x, q);
        for (r, &q) in r.iter_mut().zip(&*q) {
            *r -= q;
        }
        precondition(r, z);
    }
    let mut rho = dot(r, z);
    let mut outcome = Outcome { reference, ..Outcome::default() };
    // Also leaves at once when anything is NaN.
    if !(reference > 0.0 && rho.is_finite()) {
        return outcome;
    }
    let target = limit.tolerance * limit.tolerance * reference;
    p.copy_from_slice(z);
    while outcome.iterations < limit.iterations && rho > target {
        apply(p, q);
        let curvature = dot(p, q);
        if !(curvature > 0.0 && curvature.is_finite()) {
            break;
        }
        let alpha = rho / curvature;
        for (x, &p) in x.iter_mut().zip(&*p) {
            *x += alpha * p;
        }
        for (r, &q) in r.iter_mut().zip(&*q) {
            *r -= alpha * q;
        }
        precondition(r, z);
        let next = dot(r, z);
        let beta = next / rho;
        for (p, &z) in p.iter_mut().zip(&*z) {
            *p = z + beta * *p;
        }
        rho = next;
        outcome.iterations += 1;
    }
    outcome.residual = (rho.max(0.0) / reference).sqrt();
    outcome
}

/// Sum of products in four interleaved partial sums: a fixed order that a compiler may vectorise without changing it.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a_chunks, b_chunks) = (a.chunks_exact(4), b.chunks_exact(4));
    let (a_rest, b_rest) = (a_chunks.remainder(), b_chunks.remainder());
    for (a, b) in a_chunks.zip(b_chunks) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let mut rest = 0.0;
    for (&a, &b) in a_rest.iter().zip(b_rest) {
        rest += a * b;
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn chain(x: &[f64], y: &mut [f64]) {
        for i in 0..x.len() {
            let left = if i > 0 { x[i - 1] } else { 0.0 };
            let right = if i + 1 < x.len() { x[i + 1] } else { 0.0 };
            y[i] = 2.0 * x[i] - left - right;
        }
    }

    #[test]
    fn converges_within_the_dimension() {
        let b: Vec<f64> = (0..20).map(|i| f64::from(i * i % 7) - 3.0).collect();
        let mut x = vec![0.0; 20];
        let limit = Limit { iterations: 20, tolerance: 1e-12 };
        let outcome =
            solve(chain, <[f64]>::clone_from_slice_into, &b, &mut x, limit, &mut Workspace::default());
        assert!(outcome.residual < 1e-10, "{outcome:?}");
        let mut y = vec![0.0; 20];
        chain(&x, &mut y);
        assert!(y.iter().zip(&b).all(|(y, b)| (y - b).abs() < 1e-9));
    }

    #[test]
    fn truncated_iterates_are_descent_directions() {
        let b: Vec<f64> = (0..50).map(|i| f64::from(i % 5) - 2.0).collect();
        for iterations in 1..20 {
            let mut x = vec![0.0; 50];
            let limit = Limit { iterations, tolerance: 0.0 };
            solve(chain, <[f64]>::clone_from_slice_into, &b, &mut x, limit, &mut Workspace::default());
            assert!(dot(&x, &b) > 0.0);
        }
    }

    #[test]
    fn zero_and_nan_right_hand_sides_leave_x_alone() {
        for b in [[0.0; 3], [f64::NAN; 3]] {
            let mut x = vec![0.0; 3];
            let limit = Limit { iterations: 9, tolerance: 0.0 };
            solve(chain, <[f64]>::clone_from_slice_into, &b, &mut x, limit, &mut Workspace::default());
            assert_eq!(x, [0.0; 3]);
        }
    }

    #[test]
    fn a_direction_without_curvature_ends_it_with_what_there_is() {
        // Positive along the first two entries, negative along the third.
        let apply = |x: &[f64], y: &mut [f64]| {
            y.copy_from_slice(&[x[0], 2.0 * x[1], -9.0 * x[2]]);
        };
        let limit = Limit { iterations: 9, tolerance: 0.0 };
        let plain = <[f64]>::clone_from_slice_into;
        let mut x = vec![0.0; 3];
        let outcome = solve(apply, plain, &[0.0, 0.0, 1.0], &mut x, limit, &mut Workspace::default());
        assert_eq!((outcome.iterations, x), (0, vec![0.0; 3]));
        let mut x = vec![0.0; 3];
        let outcome = solve(apply, plain, &[1.0, 1.0, 0.1], &mut x, limit, &mut Workspace::default());
        assert!(outcome.iterations > 0 && x.iter().all(|x| x.is_finite()));
        assert!(dot(&x, &[1.0, 1.0, 0.1]) > 0.0);
    }

    /// No preconditioner.
    trait CloneInto {
        fn clone_from_slice_into(source: &Self, target: &mut Self);
    }

    impl CloneInto for [f64] {
        fn clone_from_slice_into(source: &Self, target: &mut Self) {
            target.copy_from_slice(source);
        }
    }
}
