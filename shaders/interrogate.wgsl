// What is asked of a surface instead of light: isophotes, contours, mean curvature.

// Triangles around each vertex: first, for each vertex and one more, where its own begin; then places in `indices`.
@group(1) @binding(3) var<storage, read> rings: array<u32>;

const SHADED: u32 = 0u;
const ISOPHOTES: u32 = 1u;
const CONTOURS: u32 = 2u;
const MEAN: u32 = 3u;

fn question() -> u32 {
    return u32(frame.look.x);
}

fn normal_of(vertex: u32) -> vec3f {
    return vec3f(pairs[3u * vertex + 1u].y, pairs[3u * vertex + 2u]);
}

fn turned_to(v: vec3f, side: vec3f) -> vec3f {
    return select(v, -v, dot(v, side) < 0.0);
}

// Half the trace of the shape operator at a vertex, positive where the surface bends toward `side`, one of its two
// normals: minus half the divergence of the normals, taken over the triangles around it as a field that is linear on each.
fn mean_curvature(vertex: u32, side: vec3f) -> f32 {
    var divergence = 0.0;
    var area = 0.0;
    for (var k = rings[vertex]; k < rings[vertex + 1u]; k++) {
        let first = rings[k];
        let a = indices[first];
        let b = indices[first + 1u];
        let c = indices[first + 2u];
        let at = position(a);
        let ab = position(b) - at;
        let ac = position(c) - at;
        let scale = 1.0 / max(max(length(ab), length(ac)), 1e-18);
        let flat_normal = cross(ab * scale, ac * scale);
        let twice = length(flat_normal);
        if twice < 1e-12 {
            continue;
        }
        let n = flat_normal / twice;
        let own = turned_to(n, side);
        // Twice the area times the gradient of what is 1 at a corner and 0 at the others: its normal times its edge.
        divergence += (dot(turned_to(normal_of(a), own), cross(n, ac - ab))
            + dot(turned_to(normal_of(b), own), cross(n, -ac))
            + dot(turned_to(normal_of(c), own), cross(n, ab)));
        area += twice / (scale * scale);
    }
    return -0.5 * divergence / max(area, 1e-36);
}

// Colours from blue through grey to orange, display values; 0 to 1 is the range. The legend has the same.
fn ramp(value: f32) -> vec3f {
    let t = clamp(value, 0.0, 1.0) * 4.0;
    let lowest = vec3f(0.055, 0.200, 0.478);
    let low = vec3f(0.286, 0.557, 0.824);
    let middle = vec3f(0.902, 0.902, 0.886);
    let high = vec3f(0.929, 0.600, 0.247);
    let highest = vec3f(0.545, 0.184, 0.020);
    var colour = mix(lowest, low, clamp(t, 0.0, 1.0));
    colour = mix(colour, middle, clamp(t - 1.0, 0.0, 1.0));
    colour = mix(colour, high, clamp(t - 2.0, 0.0, 1.0));
    return mix(colour, highest, clamp(t - 3.0, 0.0, 1.0));
}

// Share of a pixel that is covered by the dark half of each unit of `phase`, where `wide` of it lie in the pixel.
fn striped(phase: f32, wide: f32) -> f32 {
    let w = max(wide, 1e-6);
    // The integral of the dark halves up to a place.
    let lower = phase - 0.5 * w;
    let upper = phase + 0.5 * w;
    let below = floor(lower) * 0.5 + min(fract(lower), 0.5);
    let above = floor(upper) * 0.5 + min(fract(upper), 0.5);
    // Too fine to be seen, stripes become grey.
    return clamp((above - below) / w, 0.0, 1.0);
}

// Places whose normals make the same angle with a direction have the same colour: as many bands as said in half a turn.
fn isophotes(n: vec3f) -> vec3f {
    let angle = acos(clamp(dot(n, frame.key.xyz), -1.0, 1.0));
    let phase = angle / 3.14159265 * frame.look.y * 0.5;
    return mix(vec3f(0.96), vec3f(0.10), striped(phase, fwidth(phase)));
}

// How much of a pixel a line covers that is drawn wherever the height is a multiple of the distance.
fn contour(at: vec3f) -> f32 {
    let height = dot(at, frame.slices.xyz) * frame.slices.w;
    let wide = max(fwidth(height), 1e-6);
    let away = abs(fract(height + 0.5) - 0.5) / wide;
    let half = 0.7 * frame.options.x;
    // Closer than three widths, lines would run together.
    return clamp(half + 0.5 - away, 0.0, 1.0) * clamp(0.5 / (wide * half) - 1.0, 0.0, 1.0);
}
