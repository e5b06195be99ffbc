//! The shaders made ready for a device: one pair of pipelines, for what lies behind and for objects, for each kind of
//! pass. What the shaders do is said in the `.wgsl` files.

use super::super::backdrop::{CONTRAST, FADING, SQUARE};
use super::super::compose::{MOST_SQUARES, SHIFT};
use super::super::frame::{CATEGORY_MAP, CATEGORY_SKY};
use super::super::natural::{GROUND, OBJECTS, WALLS};
use super::super::patch::{GRAZING, SHIFT as PATCH_SHIFT};
use super::super::rows::Shows;
use super::super::shade::{FULL_LEVEL, ROUNDING, SKY_SHARE};
use super::super::surfaces::SIDE;
use super::super::view::NEAR;
use super::device::Device;
use super::instances::WORDS;
use super::library::VERTEX_LENGTH;
use super::natural::{COVER, IS_LIT};

/// Colour bytes and label, or an item's number.
pub(super) const WORD_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Near plane / depth, so that floats are dense where depths are large.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// What kind of pass a pair of pipelines is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Kind {
    /// Whether items' numbers are written beside the words.
    pub(super) items: bool,
    /// Whether any tile has fog.
    pub(super) fog: bool,
    /// Whether tiles are in the natural style.
    pub(super) natural: bool,
}

/// Where shadows fall.
pub(super) const SHADOW_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R8Uint;

/// The pipelines of a pass.
#[derive(Debug)]
pub(super) struct Pair {
    pub(super) backdrop: wgpu::RenderPipeline,
    pub(super) objects: wgpu::RenderPipeline,
}

/// The shaders of a style, and what they read.
#[derive(Debug)]
pub(super) struct Program {
    module: wgpu::ShaderModule,
    pub(super) bindings: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    made: [Option<Pair>; 4],
    pub(super) of_shadows: Option<OfShadows>,
}

/// What draws shadows before all else, and how the others read them.
#[derive(Debug)]
pub(super) struct OfShadows {
    pub(super) pipeline: wgpu::RenderPipeline,
    pub(super) bindings: wgpu::BindGroupLayout,
}

/// All pipelines that were needed so far, of the plain style and of the natural one.
#[derive(Debug)]
pub(super) struct Pipelines([Option<Program>; 2]);

impl Pipelines {
    pub(super) fn new(device: &Device) -> Self {
        Self([Some(Program::plain(device)), None])
    }

    /// The program of a style, made when it is first asked for, with the pipelines for this kind of pass.
    pub(super) fn program(&mut self, device: &Device, kind: Kind) -> (&Program, &Pair) {
        let program = self.0[usize::from(kind.natural)].get_or_insert_with(|| {
            if kind.natural {
                Program::natural(device)
            } else {
                Program::plain(device)
            }
        });
        program.with_pair(device, kind)
    }
}

impl Program {
    fn plain(device: &Device) -> Self {
        let files = [
            include_str!("pass.wgsl"),
            include_str!("tile.wgsl"),
            include_str!("backdrop.wgsl"),
            include_str!("corner.wgsl"),
            include_str!("objects.wgsl"),
        ];
        let module = module(device, &constants(), &files);
        let bindings = bindings(
            device,
            &[binding(0, STORAGE), binding(1, wgpu::BufferBindingType::Uniform)],
        );
        let layout = layout(device, &[Some(&bindings)]);
        Self {
            module,
            bindings,
            layout,
            made: [const { None }; 4],
            of_shadows: None,
        }
    }

    fn natural(device: &Device) -> Self {
        let files = [
            include_str!("pass.wgsl"),
            include_str!("corner.wgsl"),
            include_str!("natural.wgsl"),
        ];
        let module = module(device, &(constants() + &natural_constants()), &files);
        let entries = [0, 1, 2, 3, 4].map(|number| match number {
            1 => binding(1, wgpu::BufferBindingType::Uniform),
            _ => binding(number, STORAGE),
        });
        let bindings = bindings(device, &entries);
        let of_shadows = self::bindings(device, &[shadow_binding()]);
        let alone = layout(device, &[Some(&bindings)]);
        Self {
            layout: layout(device, &[Some(&bindings), Some(&of_shadows)]),
            of_shadows: Some(OfShadows {
                pipeline: shadows(device, &module, &alone),
                bindings: of_shadows,
            }),
            module,
            bindings,
            made: [const { None }; 4],
        }
    }

    fn with_pair(&mut self, device: &Device, kind: Kind) -> (&Self, &Pair) {
        let place = usize::from(kind.items) + 2 * usize::from(kind.fog);
        if self.made[place].is_none() {
            self.made[place] = Some(Pair {
                backdrop: backdrop(device, &self.module, &self.layout, kind),
                objects: objects(device, &self.module, &self.layout, kind),
            });
        }
        let pair = self.made[place].as_ref();
        (self, pair.expect("it was made right now"))
    }
}

/// Constants as the processor's renderer has them.
fn constants() -> String {
    format!(
        "const NEAR: f32 = {NEAR:?};\nconst SQUARE: f32 = {SQUARE:?};\nconst CONTRAST: vec2f = vec2f({:?}, {:?});\n\
         const FADING: vec2f = vec2f({:?}, {:?});\nconst MOST_SQUARES: f32 = {MOST_SQUARES:?};\nconst SHIFT: f32 = {SHIFT:?};\n\
         const SKY_SHARE: f32 = {SKY_SHARE:?};\nconst FULL_LEVEL: f32 = {FULL_LEVEL:?};\nconst ROUNDING: f32 = {ROUNDING:?};\n\
         const SKY: u32 = {CATEGORY_SKY}u;\nconst MAP: u32 = {CATEGORY_MAP}u;\n",
        CONTRAST[0], CONTRAST[1], FADING[0], FADING[1],
    )
}

/// Those that only the natural style needs.
fn natural_constants() -> String {
    format!(
        "const SIDE: f32 = {:?};\nconst PATCH_SHIFT: f32 = {PATCH_SHIFT:?};\nconst GRAZING: f32 = {GRAZING:?};\n\
         const GROUND: u32 = {GROUND}u;\nconst WALLS: u32 = {WALLS}u;\nconst OBJECTS: u32 = {OBJECTS}u;\n\
         const COVER: u32 = {COVER}u;\nconst IS_LIT: u32 = {IS_LIT}u;\n\
         const SHOWS_FLOOR: u32 = {}u;\nconst SHOWS_SKY: u32 = {}u;\n",
        SIDE as f32,
        Shows::Floor as u32,
        Shows::Sky as u32,
    )
}

/// A whole program: constants, then the files.
fn module(device: &Device, constants: &str, files: &[&str]) -> wgpu::ShaderModule {
    let text = files.concat();
    let source = if device.has_clip_distances {
        ["enable clip_distances;\n", constants, &text.replace("// CLIP ", "")].concat()
    } else {
        [constants, &text].concat()
    };
    device.card.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("driftworld"),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

fn bindings(device: &Device, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
    let descriptor = wgpu::BindGroupLayoutDescriptor {
        label: Some("what shaders read"),
        entries,
    };
    device.card.create_bind_group_layout(&descriptor)
}

fn layout(device: &Device, groups: &[Option<&wgpu::BindGroupLayout>]) -> wgpu::PipelineLayout {
    let descriptor = wgpu::PipelineLayoutDescriptor {
        label: Some("what shaders read"),
        bind_group_layouts: groups,
        immediate_size: 0,
    };
    device.card.create_pipeline_layout(&descriptor)
}

const STORAGE: wgpu::BufferBindingType = wgpu::BufferBindingType::Storage { read_only: true };

fn shadow_binding() -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Uint,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        },
        count: None,
    }
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

/// What lies behind: it is drawn first and overwrites whatever was there.
fn backdrop(
    device: &Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    kind: Kind,
) -> wgpu::RenderPipeline {
    let stages = Stages {
        label: "backdrop",
        vertex: "backdrop_vertex",
        fragment: "backdrop_fragment",
        buffers: &[],
        cull_mode: None,
        depth_compare: wgpu::CompareFunction::Always,
    };
    stages.pipeline(device, module, layout, kind)
}

/// Objects: drawn where nothing nearer is, and seen from the front alone.
fn objects(
    device: &Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    kind: Kind,
) -> wgpu::RenderPipeline {
    let stages = Stages {
        label: "objects",
        vertex: "objects_vertex",
        fragment: "objects_fragment",
        buffers: &triangle_buffers(),
        cull_mode: Some(wgpu::Face::Back),
        depth_compare: wgpu::CompareFunction::Greater,
    };
    stages.pipeline(device, module, layout, kind)
}

/// Shadows, drawn by themselves: there is one or there is none.
fn shadows(device: &Device, module: &wgpu::ShaderModule, layout: &wgpu::PipelineLayout) -> wgpu::RenderPipeline {
    let target = Some(wgpu::ColorTargetState {
        format: SHADOW_FORMAT,
        blend: None,
        write_mask: wgpu::ColorWrites::ALL,
    });
    device.card.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("shadows"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("shadow_vertex"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &triangle_buffers(),
        },
        // Faces that look at the light turn as those that look at the camera do.
        primitive: wgpu::PrimitiveState {
            cull_mode: Some(wgpu::Face::Back),
            front_face: wgpu::FrontFace::Ccw,
            ..Default::default()
        },
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("shadow_fragment"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[target],
        }),
        multiview_mask: None,
        cache: None,
    })
}

const CORNER: [wgpu::VertexAttribute; 3] = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4];
const INSTANCE: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
    3 => Float32x4, 4 => Float32x4, 5 => Float32x4, 6 => Float32x3, 7 => Float32x4, 8 => Uint32x3
];

/// Triangles, and instances of them.
fn triangle_buffers() -> [Option<wgpu::VertexBufferLayout<'static>>; 2] {
    [
        Some(wgpu::VertexBufferLayout {
            array_stride: (VERTEX_LENGTH * size_of::<f32>()) as u64,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &CORNER,
        }),
        Some(wgpu::VertexBufferLayout {
            array_stride: (WORDS * size_of::<u32>()) as u64,
            step_mode: wgpu::VertexStepMode::Instance,
            attributes: &INSTANCE,
        }),
    ]
}

/// In what the two pipelines of a pair differ.
struct Stages<'a> {
    label: &'a str,
    vertex: &'a str,
    fragment: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    cull_mode: Option<wgpu::Face>,
    depth_compare: wgpu::CompareFunction,
}

impl Stages<'_> {
    fn pipeline(
        &self,
        device: &Device,
        module: &wgpu::ShaderModule,
        layout: &wgpu::PipelineLayout,
        kind: Kind,
    ) -> wgpu::RenderPipeline {
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
            label: Some(self.label),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(self.vertex),
                compilation_options: compilation_options.clone(),
                buffers: self.buffers,
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: self.cull_mode,
                front_face: wgpu::FrontFace::Ccw,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(true),
                depth_compare: Some(self.depth_compare),
                stencil: wgpu::StencilState::default(),
                bias: wgpu::DepthBiasState::default(),
            }),
            multisample: wgpu::MultisampleState::default(),
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(self.fragment),
                compilation_options,
                targets: if kind.items { &targets } else { &targets[..1] },
            }),
            multiview_mask: None,
            cache: None,
        };
        device.card.create_render_pipeline(&descriptor)
    }
}
