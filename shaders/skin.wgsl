// Skins that show what a tool would make or take: translucent, denser where they are seen at a glancing angle.

struct Corner {
    // Where its place begins among the floats.
    at: u32,
    style: u32,
}

@group(1) @binding(0) var<storage, read> floats: array<f32>;
@group(1) @binding(1) var<storage, read> corners: array<Corner>;
@group(1) @binding(2) var<storage, read> styles: array<Style>;

struct Film {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) @interpolate(flat) style: u32,
}

@vertex
fn skin_vertex(@builtin(vertex_index) index: u32) -> Film {
    let corner = corners[index];
    let at = vec3f(floats[corner.at], floats[corner.at + 1u], floats[corner.at + 2u]);
    // In front of the surface that it may lie on.
    let clip = frame.clip_from_world * vec4f(lifted(at, 3.0 * frame.options.x), 1.0);
    return Film(clip, at, corner.style);
}

@fragment
fn skin_fragment(in: Film) -> @location(0) vec4f {
    let style = styles[in.style];
    let flat_normal = cross(dpdx(in.at), dpdy(in.at));
    let facing = abs(dot(flat_normal, toward_eye(in.at))) / max(length(flat_normal), 1e-30);
    let opacity = min(style.fill.a * (1.4 - 0.4 * facing), 0.9);
    return vec4f(style.fill.rgb * opacity, opacity);
}
