//! The page: wgpu passes, camera, picking, controls.
