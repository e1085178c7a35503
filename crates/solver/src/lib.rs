//! Fair curves and surfaces: energies with exact gradients, predictor, preconditioned conjugate gradients.
