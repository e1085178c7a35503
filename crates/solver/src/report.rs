//! What a step of a curve or a surface reports.

/// What one step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Discrete energy before the step.
    pub energy_before: f64,
    /// Discrete energy after it; never above `energy_before`.
    pub energy: f64,
    /// `-s g·alpha`: the decrease the gradient promised for the accepted scale.
    pub predicted_decrease: f64,
    /// Largest distance a node moved.
    pub largest_move: f64,
    /// The same in units of the node's mean edge.
    pub largest_relative_move: f64,
    /// Iterations of the conjugate gradients.
    pub cg_iterations: u32,
    /// Their relative residual.
    pub residual: f64,
    /// The least [`Budget::iterations`](crate::Budget) that would have led to the same step; `u32::MAX` if more would have
    /// led on. Curves need none.
    pub sufficient: u32,
    /// Halvings of the line search.
    pub halvings: u32,
    /// Accepted scale of the direction; 0 when nothing moved.
    pub step_scale: f64,
    /// Largest angle, in radians, by which a prescribed tangent plane is not yet where it was asked for; no shape rests
    /// before it is 0.
    pub turning: f64,
    /// The shape has come to rest: further steps gain nothing worth seeing.
    pub at_rest: bool,
    /// The search failed: positions are as they were and the next step is damped more.
    pub damped: bool,
}
