//! Checks the shaders without a device: they are valid, and their structures are those of this crate.
//!
//! Native only: the shaders are the same bytes everywhere, and the checker is large.
#![cfg(not(target_arch = "wasm32"))]

use crate::background_pass::{BACKGROUND_SHADER, GRID_SHADER};
use crate::mark_pass::{CURVE_SHADER, POINT_SHADER};
use crate::skin_pass::SKIN_SHADER;
use crate::surface_pass::SURFACE_SHADER;
use crate::uniforms::{Dot, Frame, Segment, Style, SurfaceStyle};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Module, TypeInner};
use std::mem::offset_of;

fn module(source: &str) -> Module {
    let module =
        naga::front::wgsl::parse_str(source).unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{}", e.emit_to_string(source)));
    module
}

/// Size and member offsets of a structure; the stride of its array is its size.
fn layout(source: &str, name: &str) -> (usize, Vec<usize>) {
    let module = module(source);
    let found = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some(name));
    match &found.expect("the shader declares it").1.inner {
        TypeInner::Struct { members, span } => {
            (*span as usize, members.iter().map(|m| m.offset as usize).collect())
        }
        other => panic!("{name} is {other:?}"),
    }
}

macro_rules! assert_mirrors {
    ($shader:expr, $name:ident { $($member:ident),* }) => {
        let (size, offsets) = layout($shader, stringify!($name));
        assert_eq!(size, size_of::<$name>());
        assert_eq!(offsets, [$(offset_of!($name, $member)),*]);
    };
}

#[test]
fn shaders_are_valid() {
    let entries = [
        (BACKGROUND_SHADER, vec!["background_vertex", "background_fragment"]),
        (GRID_SHADER, vec!["grid_vertex", "grid_fragment"]),
        (SURFACE_SHADER, vec!["surface_vertex", "surface_fragment"]),
        (CURVE_SHADER, vec!["curve_vertex", "curve_fragment", "hidden_curve_fragment"]),
        (SKIN_SHADER, vec!["skin_vertex", "skin_fragment"]),
        (POINT_SHADER, vec!["point_vertex", "point_fragment", "hidden_point_fragment"]),
    ];
    for (source, names) in entries {
        let found: Vec<String> = module(source).entry_points.into_iter().map(|entry| entry.name).collect();
        assert_eq!(found, names);
    }
}

#[test]
fn structures_are_mirrored() {
    assert_mirrors!(
        SURFACE_SHADER,
        Frame {
            clip_from_world,
            eye,
            forward,
            key,
            fill,
            sky,
            ground,
            front,
            back,
            wire,
            top,
            bottom,
            grid,
            axis_u,
            axis_v,
            plane_origin,
            plane_u,
            plane_v,
            plane_centre,
            viewport,
            options,
            look,
            slices
        }
    );
    assert_mirrors!(CURVE_SHADER, Style { fill, outline, half_width, outline_width, hidden, flags });
    assert_mirrors!(SURFACE_SHADER, SurfaceStyle { tint, sides });
    assert_mirrors!(CURVE_SHADER, Segment { before, start, stop, after, style });
    assert_mirrors!(POINT_SHADER, Dot { at, style });
}

#[test]
fn vertices_are_where_the_shader_looks() {
    assert_eq!(ductile_spec::VERTEX_FLOATS, 6);
    assert_eq!(ductile_spec::vertex_layout(), [0, 12, 24]);
}
