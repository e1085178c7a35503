// The work plane: lines at a distance that suits the scale, fading out toward the horizon.

struct Ground {
    @builtin(position) clip: vec4f,
    @location(0) place: vec2f,
    @location(1) at: vec3f,
}

@vertex
fn grid_vertex(@builtin(vertex_index) corner: u32) -> Ground {
    let side = vec2f(vec2u(corner & 1u, corner >> 1u)) * 2.0 - 1.0;
    let place = frame.plane_centre.xy + side * frame.plane_v.w;
    let at = frame.plane_origin.xyz + frame.plane_u.xyz * place.x + frame.plane_v.xyz * place.y;
    var clip = frame.clip_from_world * vec4f(at, 1.0);
    // A little farther away than it is, so that a surface in the plane hides it.
    if is_perspective() {
        clip.z *= 0.998;
    } else {
        clip.z -= 3e-5 * clip.w;
    }
    return Ground(clip, place, at);
}

// How much of a pixel the lines of a distance cover; nothing where they crowd.
fn lines(place: vec2f, distance: f32, width: f32) -> f32 {
    let q = place / distance;
    let step = max(fwidth(q), vec2f(1e-9));
    let off = abs(fract(q - 0.5) - 0.5) / step;
    let cover = clamp(0.5 * width + 0.5 - off, vec2f(0.0), vec2f(1.0)) * (1.0 - smoothstep(vec2f(0.08), vec2f(0.35), step));
    return max(cover.x, cover.y);
}

@fragment
fn grid_fragment(in: Ground) -> @location(0) vec4f {
    let ratio = frame.options.x;
    let fine = lines(in.place, frame.plane_origin.w, ratio) * frame.plane_u.w * 0.5;
    let coarse = lines(in.place, frame.plane_origin.w * 10.0, ratio);
    var colour = frame.grid.rgb;
    var opacity = max(fine, coarse) * frame.grid.a;
    // The two axes of the plane.
    let step = max(fwidth(in.place), vec2f(1e-9));
    let on_axis = clamp(0.7 * ratio + 0.5 - abs(in.place) / step, vec2f(0.0), vec2f(1.0));
    colour = mix(colour, frame.axis_u.rgb, on_axis.y);
    colour = mix(colour, frame.axis_v.rgb, on_axis.x);
    opacity = max(opacity, max(on_axis.x * frame.axis_v.a, on_axis.y * frame.axis_u.a));
    let away = length(in.place - frame.plane_centre.xy) / frame.plane_v.w;
    opacity *= 1.0 - smoothstep(0.15, 0.95, away);
    // Lines seen at a glancing angle crowd into a haze.
    let slope = abs(dot(normalize(cross(frame.plane_u.xyz, frame.plane_v.xyz)), toward_eye(in.at)));
    opacity *= smoothstep(0.0, 0.12, slope);
    return vec4f(colour * opacity, opacity);
}
