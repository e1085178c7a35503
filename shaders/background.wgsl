// A soft vertical gradient behind everything.

struct Sky {
    @builtin(position) clip: vec4f,
    @location(0) height: f32,
}

@vertex
fn background_vertex(@builtin(vertex_index) corner: u32) -> Sky {
    // One triangle that covers the canvas.
    let at = vec2f(f32(corner & 1u) * 4.0 - 1.0, f32(corner >> 1u) * 4.0 - 1.0);
    return Sky(vec4f(at, 0.0, 1.0), at.y * 0.5 + 0.5);
}

@fragment
fn background_fragment(in: Sky) -> @location(0) vec4f {
    // Half a step of ordered noise keeps the gradient free of bands (Jimenez 2014).
    let noise = fract(52.9829189 * fract(dot(floor(in.clip.xy), vec2f(0.06711056, 0.00583715))));
    let colour = mix(frame.bottom.rgb, frame.top.rgb, smoothstep(0.0, 1.0, in.height));
    return vec4f(colour + (noise - 0.5) / 255.0, 1.0);
}
