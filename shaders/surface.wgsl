// Surfaces: Phong per fragment, two-sided, also where a surface has one side only.
//
// Vertices are pulled from storage, triangle by triangle, because on a Möbius strip the normals of
// neighbouring vertices may point to different sides: each is turned to the side of the triangle before it
// is interpolated. The same corners give barycentric coordinates, and with them the mesh lines.

struct SurfaceStyle {
    // Display colour of a tool's tint; a: how strong.
    tint: vec4f,
    // x: 1 if the surface has two sides, which then differ; y: how strong the tint is where `influence` is 1.
    sides: vec4f,
}

// Six floats a vertex, two at a time: position, then normal.
@group(1) @binding(0) var<storage, read> pairs: array<vec2f>;
@group(1) @binding(1) var<storage, read> indices: array<u32>;
@group(1) @binding(2) var<storage, read> styles: array<SurfaceStyle>;
// By how much each vertex would follow a hand; of a surface without `y` in its sides nothing is said.
@group(1) @binding(4) var<storage, read> influence: array<f32>;

struct Facet {
    @builtin(position) clip: vec4f,
    @location(0) at: vec3f,
    @location(1) normal: vec3f,
    // Barycentric, the first two.
    @location(2) weights: vec2f,
    @location(3) @interpolate(flat) style: u32,
    // Mean curvature, where that is asked for.
    @location(4) mean: f32,
    @location(5) influence: f32,
}

fn position(vertex: u32) -> vec3f {
    return vec3f(pairs[3u * vertex], pairs[3u * vertex + 1u].x);
}

@vertex
fn surface_vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) surface: u32) -> Facet {
    let corner = index % 3u;
    // The own vertex first, then the other two in their order round the triangle.
    let own = indices[index];
    let second = indices[select(index + 1u, index - 2u, corner == 2u)];
    let third = indices[select(index + 2u, index - 1u, corner != 0u)];
    let middle = pairs[3u * own + 1u];
    let at = vec3f(pairs[3u * own], middle.x);
    let normal = vec3f(middle.y, pairs[3u * own + 2u]);
    // Scaled, so that the product of small edges does not vanish.
    let ab = position(second) - at;
    let ac = position(third) - at;
    let scale = 1.0 / max(max(length(ab), length(ac)), 1e-18);
    let flat_normal = cross(ab * scale, ac * scale);
    var facet: Facet;
    facet.clip = frame.clip_from_world * vec4f(at, 1.0);
    facet.at = at;
    facet.normal = select(normal, -normal, dot(normal, flat_normal) < 0.0);
    facet.weights = vec2f(vec2u(corner) == vec2u(0u, 1u));
    facet.style = surface;
    facet.influence = 0.0;
    if styles[surface].sides.y > 0.0 {
        facet.influence = styles[surface].sides.y * influence[own];
    }
    facet.mean = 0.0;
    if question() == MEAN {
        // Of the two sides the one of the stored normal, whichever triangle is drawn; a surface with one side has none.
        let side = select(facet.normal, normal, styles[surface].sides.x > 0.5);
        facet.mean = mean_curvature(own, side);
    }
    return facet;
}

// Light that a place sends to the eye. `n` is on the side of the eye.
fn lit(albedo: vec3f, n: vec3f, to_eye: vec3f) -> vec3f {
    let facing = max(dot(n, to_eye), 0.0);
    // The terminator is softened a little, as by a large lamp.
    let key = max((dot(n, frame.key.xyz) + 0.2) / 1.2, 0.0);
    let fill = max((dot(n, frame.fill.xyz) + 0.4) / 1.4, 0.0);
    let above = mix(frame.ground.rgb, frame.sky.rgb, 0.5 + 0.5 * n.z);
    var light = albedo * (above + vec3f(1.0, 0.965, 0.91) * (frame.key.w * key * sqrt(key)) + vec3f(0.78, 0.88, 1.0) * (frame.fill.w * fill));
    let half_way = normalize(frame.key.xyz + to_eye);
    // Powers by multiplication: 10 for a broad sheen, 56 for the highlight.
    let shine = max(dot(n, half_way), 0.0);
    let shine_2 = shine * shine;
    let shine_4 = shine_2 * shine_2;
    let shine_8 = shine_4 * shine_4;
    let shine_16 = shine_8 * shine_8;
    let highlight = shine_16 * shine_16 * shine_16 * shine_8;
    light += vec3f(1.0, 0.98, 0.95) * frame.key.w * (0.16 * highlight + 0.05 * shine_8 * shine_2);
    let rim_2 = (1.0 - facing) * (1.0 - facing);
    let rim = rim_2 * rim_2;
    light += frame.sky.rgb * (frame.sky.w * rim * (0.6 + 0.4 * n.z));
    return max(light, vec3f(0.0));
}

@fragment
fn surface_fragment(in: Facet, @builtin(front_facing) is_front: bool) -> @location(0) vec4f {
    let style = styles[in.style];
    let to_eye = toward_eye(in.at);
    var n = normalize(in.normal);
    n = select(-n, n, is_front);
    let facing = dot(n, to_eye);
    // Near the outline the smooth normal may point away although the triangle is seen: bend it back.
    n = normalize(n - to_eye * min(facing - 0.02, 0.0));
    // The slivers of back that rounding lets through at the outline are not told apart.
    let back = select(style.sides.x * smoothstep(0.05, 0.2, facing), 0.0, is_front);
    let albedo = mix(frame.front.rgb, frame.back.rgb, back);
    var colour = encoded(softened(lit(albedo, n, to_eye)));
    // Derivatives are taken where all fragments are.
    let bands = isophotes(n);
    let line_at = contour(in.at);
    // A little light keeps the form.
    let form = 0.72 + 0.28 * max(dot(n, frame.key.xyz), 0.0);
    switch question() {
        case ISOPHOTES: { colour = bands; }
        case CONTOURS: { colour = mix(colour, frame.wire.rgb, 0.85 * line_at); }
        case MEAN: { colour = ramp((in.mean - frame.look.y) * frame.look.z) * form; }
        default: {}
    }
    colour = mix(colour, style.tint.rgb, max(style.tint.a, in.influence));

    let weights = vec3f(in.weights, 1.0 - in.weights.x - in.weights.y);
    let edge = weights / max(fwidth(weights), vec3f(1e-6));
    let nearest = min(edge.x, min(edge.y, edge.z));
    let line = frame.options.z * frame.wire.a * clamp(0.5 * frame.options.x + 0.5 - nearest, 0.0, 1.0);
    return vec4f(mix(colour, frame.wire.rgb, line), 1.0);
}

// Leaves the darks as they are and bends the lights below white.
fn softened(light: vec3f) -> vec3f {
    let knee = vec3f(0.6);
    let over = max(light - knee, vec3f(0.0));
    return min(light, knee) + 0.4 * over / (over + 0.4);
}
