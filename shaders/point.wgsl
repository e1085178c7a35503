// Points: discs of constant size on the screen, with an outline and perhaps a letter.

struct Dot {
    // Where its place begins among the floats.
    at: u32,
    style: u32,
}

@group(1) @binding(0) var<storage, read> floats: array<f32>;
@group(1) @binding(1) var<storage, read> dots: array<Dot>;
@group(1) @binding(2) var<storage, read> styles: array<Style>;

struct Disc {
    @builtin(position) @invariant clip: vec4f,
    @location(0) @interpolate(flat) centre: vec2f,
    @location(1) @interpolate(flat) style: u32,
}

@vertex
fn point_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) index: u32) -> Disc {
    let mark = dots[index];
    let style = styles[mark.style];
    let at = vec3f(floats[mark.at], floats[mark.at + 1u], floats[mark.at + 2u]);
    let reach = (style.half_width + style.outline_width) * frame.options.x + 1.0;
    var disc: Disc;
    disc.style = mark.style;
    var centre = at;
    if (style.flags & 1u) == 0u {
        if is_perspective() && depth_of(at) <= frame.options.y {
            disc.clip = vec4f(0.0, 0.0, 2.0, 1.0);
            return disc;
        }
        centre = pixel_of(lifted(at, reach + 6.0 * frame.options.x));
    }
    disc.centre = centre.xy;
    let side = vec2f(vec2u(corner & 1u, corner >> 1u)) * 2.0 - 1.0;
    disc.clip = clip_of(centre.xy + side * reach, centre.z);
    return disc;
}

fn to_stroke(at: vec2f, start: vec2f, stop: vec2f) -> f32 {
    let step = stop - start;
    return length(at - start - step * clamp(dot(at - start, step) / dot(step, step), 0.0, 1.0));
}

// Distance to a letter in a box of −1 … 1, y down.
fn to_letter(letter: u32, at: vec2f) -> f32 {
    let x = 0.72;
    if letter == 1u {
        return min(to_stroke(at, vec2f(-x, -1.0), vec2f(x, 1.0)), to_stroke(at, vec2f(x, -1.0), vec2f(-x, 1.0)));
    }
    if letter == 2u {
        let arms = min(to_stroke(at, vec2f(-x, -1.0), vec2f(0.0, 0.05)), to_stroke(at, vec2f(x, -1.0), vec2f(0.0, 0.05)));
        return min(arms, to_stroke(at, vec2f(0.0, 0.05), vec2f(0.0, 1.0)));
    }
    let bars = min(to_stroke(at, vec2f(-x, -1.0), vec2f(x, -1.0)), to_stroke(at, vec2f(-x, 1.0), vec2f(x, 1.0)));
    return min(bars, to_stroke(at, vec2f(x, -1.0), vec2f(-x, 1.0)));
}

fn disc_ink(in: Disc) -> vec4f {
    let style = styles[in.style];
    let offset = in.clip.xy - in.centre;
    var ink = inked(style, length(offset));
    let letter = (style.flags >> 8u) & 3u;
    if letter != 0u {
        let size = 0.42 * style.half_width * frame.options.x;
        let distance = to_letter(letter, offset / size) * size;
        let stroke = clamp(0.85 * frame.options.x + 0.5 - distance, 0.0, 1.0);
        ink = mix(ink, vec4f(1.0), stroke * ink.a);
    }
    return ink;
}

@fragment
fn point_fragment(in: Disc) -> @location(0) vec4f {
    return disc_ink(in);
}

@fragment
fn hidden_point_fragment(in: Disc) -> @location(0) vec4f {
    return disc_ink(in) * styles[in.style].hidden;
}
