//! Draws the 3D view into a texture of its own, with its own depth buffer and four samples per pixel, and
//! passes it to egui as an image. So it works in the window, in tests and without a window.

use super::orbit::Orbit;
use super::solid::{CORNER_FLOATS, Corner};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use egui::Color32;

/// Samples per pixel: every adapter of WebGPU's baseline supports 4.
const SAMPLES: u32 = 4;
/// Bytes per corner of a triangle or line.
const CORNER_BYTES: u64 = 4 * CORNER_FLOATS as u64;
/// Format of the image: egui expects images that are encoded as sRGB, but in a format that is not marked as
/// sRGB.
const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Format of the depth buffer.
const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Floats of the view uniforms: a matrix and two directions.
const VIEW_FLOATS: usize = 24;

/// Draws solids into an image.
pub struct StageRenderer {
    state: RenderState,
    triangles: wgpu::RenderPipeline,
    lines: wgpu::RenderPipeline,
    view: wgpu::Buffer,
    bindings: wgpu::BindGroup,
    target: Option<Target>,
}

/// Corners of triangles or lines, in a buffer of the graphics card.
#[derive(Default)]
pub struct CornerBuffer {
    buffer: Option<wgpu::Buffer>,
    count: u32,
}

struct Target {
    size: [u32; 2],
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    resolved: wgpu::TextureView,
    id: egui::TextureId,
}

impl StageRenderer {
    /// Prepares drawing with the window's graphics card.
    pub fn new(state: &RenderState) -> Self {
        let device = &state.device;
        let shader = device.create_shader_module(wgpu::include_wgsl!("stage.wgsl"));
        let view = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: 4 * VIEW_FLOATS as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("view"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry {
                binding: 0,
                resource: view.as_entire_binding(),
            }],
        });
        let of = |topology| pipeline(device, &shader, &layout, topology);
        Self {
            triangles: of(wgpu::PrimitiveTopology::TriangleList),
            lines: of(wgpu::PrimitiveTopology::LineList),
            view,
            bindings,
            target: None,
            state: state.clone(),
        }
    }

    /// Uploads corners to the graphics card.
    pub fn upload(&self, corners: &[Corner], into: &mut CornerBuffer) {
        let bytes: Vec<u8> = corners
            .iter()
            .flat_map(Corner::floats)
            .flat_map(f32::to_ne_bytes)
            .collect();
        let needed = bytes.len() as u64;
        into.count = corners.len() as u32;
        if needed == 0 {
            return;
        }
        let buffer = match into.buffer.take() {
            Some(buffer) if buffer.size() >= needed => buffer,
            _ => self.state.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("corners"),
                size: needed.next_multiple_of(64 * CORNER_BYTES),
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }),
        };
        self.state.queue.write_buffer(&buffer, 0, &bytes);
        into.buffer = Some(buffer);
    }

    /// Draws triangles and lines on the background colour `ground`, as seen by the eye; returns the image,
    /// of a size (pixels).
    pub fn draw(
        &mut self,
        orbit: &Orbit,
        (size, ground): ([u32; 2], Color32),
        triangles: &[&CornerBuffer],
        lines: &CornerBuffer,
    ) -> egui::TextureId {
        self.view_uniforms(orbit, size);
        let target = match self.target.take() {
            Some(target) if target.size == size => target,
            old => self.make_target(size, old),
        };
        let device = &self.state.device;
        let mut encoder = device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("stage"),
                color_attachments: &[Some(target.colour(ground))],
                depth_stencil_attachment: Some(target.depth()),
                ..Default::default()
            });
            pass.set_bind_group(0, &self.bindings, &[]);
            let lists = triangles.iter().map(|list| (&self.triangles, *list));
            for (pipeline, list) in lists.chain([(&self.lines, lines)]) {
                if let (Some(buffer), 1..) = (&list.buffer, list.count) {
                    pass.set_pipeline(pipeline);
                    pass.set_vertex_buffer(0, buffer.slice(..));
                    pass.draw(0..list.count, 0..1);
                }
            }
        }
        self.state.queue.submit([encoder.finish()]);
        let id = target.id;
        self.target = Some(target);
        id
    }

    /// Writes the uniforms of the view: the projection and the directions of the lamps.
    fn view_uniforms(&self, orbit: &Orbit, size: [u32; 2]) {
        let aspect = f64::from(size[0]) / f64::from(size[1].max(1));
        let [right, up] = orbit.axes();
        let back = (orbit.eye() - orbit.target).normalize();
        let key = (back * 0.75 + up * 0.75 - right * 0.55).normalize();
        let fill = (back * 0.4 + right).normalize();
        let mut floats: Vec<f32> = orbit
            .clip_from_world(aspect)
            .into_iter()
            .flatten()
            .collect();
        for way in [key, fill] {
            floats.extend(way.iter().map(|x| *x as f32));
            floats.push(0.0);
        }
        let bytes: Vec<u8> = floats.into_iter().flat_map(f32::to_ne_bytes).collect();
        self.state.queue.write_buffer(&self.view, 0, &bytes);
    }

    fn make_target(&self, size: [u32; 2], old: Option<Target>) -> Target {
        let texture = |format, sample_count, usage| {
            self.state
                .device
                .create_texture(&wgpu::TextureDescriptor {
                    label: Some("stage"),
                    size: wgpu::Extent3d {
                        width: size[0].max(1),
                        height: size[1].max(1),
                        depth_or_array_layers: 1,
                    },
                    mip_level_count: 1,
                    sample_count,
                    dimension: wgpu::TextureDimension::D2,
                    format,
                    usage,
                    view_formats: &[],
                })
                .create_view(&Default::default())
        };
        let drawn = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let read = drawn | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let resolved = texture(COLOUR, 1, read);
        let device = &self.state.device;
        let filter = wgpu::FilterMode::Linear;
        let mut renderer = self.state.renderer.write();
        let id = match old {
            Some(old) => {
                renderer.update_egui_texture_from_wgpu_texture(device, &resolved, filter, old.id);
                old.id
            }
            None => renderer.register_native_texture(device, &resolved, filter),
        };
        Target {
            size,
            samples: texture(COLOUR, SAMPLES, drawn),
            depth: texture(DEPTH, SAMPLES, drawn),
            resolved,
            id,
        }
    }
}

impl Target {
    fn colour(&self, ground: Color32) -> wgpu::RenderPassColorAttachment<'_> {
        let [red, green, blue, _] = ground.to_normalized_gamma_f32().map(f64::from);
        wgpu::RenderPassColorAttachment {
            view: &self.samples,
            depth_slice: None,
            resolve_target: Some(&self.resolved),
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color {
                    r: red,
                    g: green,
                    b: blue,
                    a: 1.0,
                }),
                store: wgpu::StoreOp::Discard,
            },
        }
    }

    fn depth(&self) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.depth,
            depth_ops: Some(wgpu::Operations {
                load: wgpu::LoadOp::Clear(1.0),
                store: wgpu::StoreOp::Discard,
            }),
            stencil_ops: None,
        }
    }
}

fn pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    layout: &wgpu::BindGroupLayout,
    topology: wgpu::PrimitiveTopology,
) -> wgpu::RenderPipeline {
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];
    let entry = match topology {
        wgpu::PrimitiveTopology::LineList => "rim",
        _ => "corner",
    };
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("stage"),
        layout: Some(
            &device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some("stage"),
                bind_group_layouts: &[Some(layout)],
                immediate_size: 0,
            }),
        ),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: CORNER_BYTES,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &attributes,
            })],
        },
        primitive: wgpu::PrimitiveState {
            topology,
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Less),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState {
            count: SAMPLES,
            ..Default::default()
        },
        fragment: Some(wgpu::FragmentState {
            module: shader,
            entry_point: Some("surface"),
            compilation_options: Default::default(),
            targets: &[Some(COLOUR.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    use eframe::wgpu::naga;

    #[test]
    fn the_shader_is_valid_and_has_the_entry_points_named_here() {
        let module = naga::front::wgsl::parse_str(include_str!("stage.wgsl"));
        let module = module.unwrap_or_else(|error| panic!("{error}"));
        naga::valid::Validator::new(Default::default(), Default::default())
            .validate(&module)
            .unwrap();
        let names: Vec<_> = module.entry_points.iter().map(|e| &*e.name).collect();
        assert_eq!(names, ["corner", "rim", "surface"]);
    }
}
