// Curves of constant width on the screen: each segment is a quad, its ends round, its edges soft.
//
// Neighbouring segments are parted by the line that halves their angle, so that no pixel is inked twice and
// a translucent curve has no knots.

struct Segment {
    // Where the four places begin among the floats; the first equals the second at an open end, and the
    // last the third.
    before: u32,
    start: u32,
    stop: u32,
    after: u32,
    style: u32,
}

@group(1) @binding(0) var<storage, read> floats: array<f32>;
@group(1) @binding(1) var<storage, read> segments: array<Segment>;
@group(1) @binding(2) var<storage, read> styles: array<Style>;

// Device pixels by which curves are lifted off a surface.
const LIFT: f32 = 6.0;

struct Stroke {
    @builtin(position) @invariant clip: vec4f,
    @location(0) @interpolate(flat) ends: vec4f,
    // Across the cut at the start (xy) and at the stop (zw); zero where the curve ends.
    @location(1) @interpolate(flat) cuts: vec4f,
    @location(2) @interpolate(flat) style: u32,
}

fn vector(at: u32) -> vec3f {
    return vec3f(floats[at], floats[at + 1u], floats[at + 2u]);
}

// A place, or where the way to it from another leaves the space before the eye.
fn before_eye(at: vec3f, other: vec3f) -> vec3f {
    let near = frame.options.y * 1.01;
    let depth = depth_of(at);
    let far = depth_of(other);
    if !is_perspective() || depth >= near || far <= near {
        return at;
    }
    return mix(at, other, (near - depth) / (far - depth));
}

fn on_screen(at: vec3f, flags: u32) -> vec3f {
    if (flags & 1u) != 0u {
        return at;
    }
    return pixel_of(lifted(at, LIFT * frame.options.x));
}

// Across the line that halves the angle of two steps.
fn cut(first: vec2f, second: vec2f) -> vec2f {
    let sum = normalize(first) + normalize(second);
    let size = length(sum);
    if size > 0.01 {
        return sum / size;
    }
    return normalize(second);
}

// How far beyond its end a segment may reach: a round cap where the curve ends, else only as far as the cut
// slants.
fn overhang(along: vec2f, across: vec2f, reach: f32) -> f32 {
    let cosine = dot(along, across);
    if all(across == vec2f(0.0)) || cosine < 0.7 {
        return reach;
    }
    return reach * sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine + 0.75;
}

@vertex
fn curve_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) index: u32) -> Stroke {
    let segment = segments[index];
    let style = styles[segment.style];
    let start_in_world = vector(segment.start);
    let stop_in_world = vector(segment.stop);
    var stroke: Stroke;
    stroke.style = segment.style;
    let is_world = (style.flags & 1u) == 0u;
    let near = frame.options.y;
    if is_world && is_perspective() && max(depth_of(start_in_world), depth_of(stop_in_world)) <= near * 1.01 {
        stroke.clip = vec4f(0.0, 0.0, 2.0, 1.0);
        return stroke;
    }
    var first = start_in_world;
    var last = stop_in_world;
    var previous = vector(segment.before);
    var next = vector(segment.after);
    if is_world {
        first = before_eye(start_in_world, stop_in_world);
        last = before_eye(stop_in_world, start_in_world);
        previous = before_eye(previous, start_in_world);
        next = before_eye(next, stop_in_world);
    }
    let a = on_screen(first, style.flags);
    let b = on_screen(last, style.flags);
    let p = on_screen(previous, style.flags);
    let n = on_screen(next, style.flags);
    let step = b.xy - a.xy;
    let size = length(step);
    let along = select(vec2f(1.0, 0.0), step / max(size, 1e-9), size > 1e-6);
    let before = a.xy - p.xy;
    let after = n.xy - b.xy;
    var cuts = vec4f(0.0);
    if segment.before != segment.start && length(before) > 1e-6 {
        cuts = vec4f(cut(before, along), 0.0, 0.0);
    }
    if segment.after != segment.stop && length(after) > 1e-6 {
        cuts = vec4f(cuts.xy, cut(along, after));
    }
    stroke.ends = vec4f(a.xy, b.xy);
    stroke.cuts = cuts;
    let reach = (style.half_width + style.outline_width) * frame.options.x + 1.0;
    let is_stop = (corner & 1u) != 0u;
    let side = select(-1.0, 1.0, (corner & 2u) != 0u);
    let over = overhang(along, select(cuts.xy, cuts.zw, is_stop), reach);
    let at = select(a.xy - along * over, b.xy + along * over, is_stop);
    stroke.clip = clip_of(at + vec2f(-along.y, along.x) * (side * reach), select(a.z, b.z, is_stop));
    return stroke;
}

fn stroke_ink(in: Stroke) -> vec4f {
    let at = in.clip.xy;
    let from_start = at - in.ends.xy;
    let from_stop = at - in.ends.zw;
    let is_before = dot(from_start, in.cuts.xy) < 0.0;
    let is_after = any(in.cuts.zw != vec2f(0.0)) && dot(from_stop, in.cuts.zw) >= 0.0;
    if is_before || is_after {
        // No ink; cheaper than to discard, which would delay the test of depth.
        return vec4f(0.0);
    }
    let step = in.ends.zw - in.ends.xy;
    let part = clamp(dot(from_start, step) / max(dot(step, step), 1e-9), 0.0, 1.0);
    return inked(styles[in.style], length(from_start - step * part));
}

@fragment
fn curve_fragment(in: Stroke) -> @location(0) vec4f {
    return stroke_ink(in);
}

@fragment
fn hidden_curve_fragment(in: Stroke) -> @location(0) vec4f {
    return stroke_ink(in) * styles[in.style].hidden;
}
