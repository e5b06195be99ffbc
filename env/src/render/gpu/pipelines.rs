//! Compiles the shaders for a device: for each kind of pass, a pipeline for the background and one for objects.

use super::super::backdrop::{CONTRAST, FADING, SQUARE};
use super::super::compose::{MAX_SQUARES, SHIFT};
use super::super::frame::{CATEGORY_MAP, CATEGORY_SKY};
use super::super::shade::{FULL_LEVEL, ROUNDING, SKY_SHARE};
use super::super::view::NEAR;
use super::device::Device;
use super::instances::WORDS;
use super::library::VERTEX_LENGTH;

/// Colour bytes with a label, or an item's index.
pub(super) const WORD_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Stores near plane / depth, because floats are dense where depths are large.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A kind of pass, which needs its own pair of pipelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    /// Whether items' indices are written as well.
    pub(super) items: bool,
    /// Whether any tile has fog.
    pub(super) fog: bool,
}

/// Both pipelines of a pass.
#[derive(Debug)]
pub(super) struct Pair {
    pub(super) backdrop: wgpu::RenderPipeline,
    pub(super) objects: wgpu::RenderPipeline,
}

/// All pipelines created so far.
#[derive(Debug)]
pub(super) struct Pipelines {
    program: Program,
    pub(super) bindings: wgpu::BindGroupLayout,
    pairs: [Option<Pair>; 4],
}

/// State shared by all pipelines.
#[derive(Debug)]
struct Program {
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
}

impl Pipelines {
    pub(super) fn new(device: &Device) -> Self {
        let module = device.card.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("driftworld"),
            source: wgpu::ShaderSource::Wgsl(source(device.has_clip_distances).into()),
        });
        let bindings = device.card.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("tiles and atlas"),
            entries: &[
                binding(0, wgpu::BufferBindingType::Storage { read_only: true }),
                binding(1, wgpu::BufferBindingType::Uniform),
            ],
        });
        let layout = device.card.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("tiles and atlas"),
            bind_group_layouts: &[Some(&bindings)],
            immediate_size: 0,
        });
        Self {
            program: Program { module, layout },
            bindings,
            pairs: [const { None }; 4],
        }
    }

    /// The pipelines for a kind of pass, created on first use.
    pub(super) fn pair(&mut self, device: &Device, kind: Kind) -> &Pair {
        let index = usize::from(kind.items) + 2 * usize::from(kind.fog);
        self.pairs[index].get_or_insert_with(|| Pair {
            backdrop: self.program.backdrop(device, kind),
            objects: self.program.objects(device, kind),
        })
    }
}

/// The shader source: the CPU renderer's constants, then the files.
fn source(has_clip_distances: bool) -> String {
    let constants = format!(
        "const NEAR: f32 = {NEAR:?};\nconst SQUARE: f32 = {SQUARE:?};\nconst CONTRAST: vec2f = vec2f({:?}, {:?});\n\
         const FADING: vec2f = vec2f({:?}, {:?});\nconst MAX_SQUARES: f32 = {MAX_SQUARES:?};\nconst SHIFT: f32 = {SHIFT:?};\n\
         const SKY_SHARE: f32 = {SKY_SHARE:?};\nconst FULL_LEVEL: f32 = {FULL_LEVEL:?};\nconst ROUNDING: f32 = {ROUNDING:?};\n\
         const SKY: u32 = {CATEGORY_SKY}u;\nconst MAP: u32 = {CATEGORY_MAP}u;\n",
        CONTRAST[0], CONTRAST[1], FADING[0], FADING[1],
    );
    let objects = include_str!("objects.wgsl");
    let (enable, objects) = if has_clip_distances {
        ("enable clip_distances;\n", objects.replace("// CLIP ", ""))
    } else {
        ("", objects.to_owned())
    };
    [
        enable,
        &constants,
        include_str!("tile.wgsl"),
        include_str!("backdrop.wgsl"),
        &objects,
    ]
    .concat()
}

fn binding(binding: u32, ty: wgpu::BufferBindingType) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }
}

/// Differences between the two pipelines of a pair.
struct Stages<'a> {
    label: &'a str,
    vertex: &'a str,
    fragment: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    cull_mode: Option<wgpu::Face>,
    depth_compare: wgpu::CompareFunction,
}

impl Program {
    /// The background, drawn first, over leftovers of earlier passes.
    fn backdrop(&self, device: &Device, kind: Kind) -> wgpu::RenderPipeline {
        let stages = Stages {
            label: "backdrop",
            vertex: "backdrop_vertex",
            fragment: "backdrop_fragment",
            buffers: &[],
            cull_mode: None,
            depth_compare: wgpu::CompareFunction::Always,
        };
        self.pipeline(device, kind, &stages)
    }

    /// Objects, drawn with depth test and back-face culling.
    fn objects(&self, device: &Device, kind: Kind) -> wgpu::RenderPipeline {
        let corner = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];
        let instance = wgpu::vertex_attr_array![
            3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x3, 7 => Float32x4, 8 => Uint32x3
        ];
        let stages = Stages {
            label: "objects",
            vertex: "objects_vertex",
            fragment: "objects_fragment",
            buffers: &[
                Some(wgpu::VertexBufferLayout {
                    array_stride: (VERTEX_LENGTH * size_of::<f32>()) as u64,
                    step_mode: wgpu::VertexStepMode::Vertex,
                    attributes: &corner,
                }),
                Some(wgpu::VertexBufferLayout {
                    array_stride: (WORDS * size_of::<u32>()) as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &instance,
                }),
            ],
            cull_mode: Some(wgpu::Face::Back),
            depth_compare: wgpu::CompareFunction::Greater,
        };
        self.pipeline(device, kind, &stages)
    }

    fn pipeline(&self, device: &Device, kind: Kind, stages: &Stages<'_>) -> wgpu::RenderPipeline {
        let constants = [("FOG", if kind.fog { 1.0 } else { 0.0 })];
        let compilation_options = wgpu::PipelineCompilationOptions {
            constants: &constants,
            ..Default::default()
        };
        let target = Some(wgpu::ColorTargetState {
            format: WORD_FORMAT,
            blend: None,
            write_mask: wgpu::ColorWrites::ALL,
        });
        let targets = [target.clone(), target];
        let descriptor = wgpu::RenderPipelineDescriptor {
            label: Some(stages.label),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: &self.module,
                entry_point: Some(stages.vertex),
                compilation_options: compilation_options.clone(),
                buffers: stages.buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: stages.cull_mode,
                front_face: wgpu::FrontFace::Ccw,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(stages.depth_compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module: &self.module,
                entry_point: Some(stages.fragment),
                compilation_options,
                targets: if kind.items { &targets } else { &targets[..1] },
            }),
            multiview_mask: None,
            cache: None,
        };
        device.card.create_render_pipeline(&descriptor)
    }
}
