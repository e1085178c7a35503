//! Connectivity of a surface, orientable or not: construction, surgery, checks, remeshing, formats.
