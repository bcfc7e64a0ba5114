// Lights the mannequin and the cloth: a lamp over the viewer's left shoulder, and ambient light from sky
// and floor. Colours are linear in the computation; the output is encoded as sRGB, as egui expects its
// images.

struct View {
    clip_from_world: mat4x4<f32>,
    // Directions toward the main light and the fill light, in the world.
    key: vec4<f32>,
    fill: vec4<f32>,
};

@group(0) @binding(0) var<uniform> view: View;

struct Corner {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) colour: vec4<f32>,
};

fn seen(position: vec3<f32>, normal: vec3<f32>, colour: vec4<f32>) -> Corner {
    var out: Corner;
    out.clip = view.clip_from_world * vec4<f32>(position, 1.0);
    out.normal = normal;
    out.colour = colour;
    return out;
}

@vertex
fn corner(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) colour: vec4<f32>,
) -> Corner {
    return seen(position, normal, colour);
}

// Boundary edges lie on the cloth: they are drawn 4 mm nearer to the eye, or the cloth would hide half of
// them. Depth is 1 - near / w except for a part in a thousand, with near = 0.05 m, so d mm are 0.05 d / w
// in clip space.
@vertex
fn rim(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) colour: vec4<f32>,
) -> Corner {
    var out = seen(position, normal, colour);
    out.clip.z -= 0.05 * 0.004 / out.clip.w;
    return out;
}

fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let low = linear * 12.92;
    let high = 1.055 * pow(max(linear, vec3<f32>(0.0031308)), vec3<f32>(1.0 / 2.4)) - 0.055;
    return select(high, low, linear <= vec3<f32>(0.0031308));
}

fn lit(normal: vec3<f32>, colour: vec3<f32>) -> vec3<f32> {
    let sky = vec3<f32>(0.50, 0.51, 0.53);
    let ground = vec3<f32>(0.27, 0.255, 0.24);
    let around = mix(ground, sky, 0.5 + 0.5 * normal.y);
    // The main light reaches a little beyond the surfaces that it grazes, so that folds darken softly.
    let key = max((dot(normal, view.key.xyz) + 0.25) / 1.25, 0.0);
    let fill = max(dot(normal, view.fill.xyz), 0.0);
    return colour * (around + vec3<f32>(0.62, 0.60, 0.57) * key * key + 0.10 * fill);
}

@fragment
fn surface(in: Corner, @builtin(front_facing) front: bool) -> @location(0) vec4<f32> {
    let finish = in.colour.a;
    var normal = normalize(in.normal);
    var colour = in.colour.rgb;
    if finish > 1.5 && !front {
        normal = -normal;
        colour = colour * 0.62;
    }
    if finish > 0.5 {
        colour = lit(normal, colour);
    }
    return vec4<f32>(encoded(clamp(colour, vec3<f32>(0.0), vec3<f32>(1.0))), 1.0);
}
