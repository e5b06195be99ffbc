//! A graphics device that never panics: what goes wrong on it is noted and handed out as an error. Which device it is,
//! is chosen in `adapter.rs`.

use std::sync::{Arc, Mutex, PoisonError};

use crate::EnvError;

/// A device with its queue, its limits and what it complains about.
#[derive(Debug)]
pub(super) struct Device {
    pub(super) card: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) info: wgpu::AdapterInfo,
    pub(super) limits: wgpu::Limits,
    /// Whether triangles can be cut at the edges of their tile; else there is a pass of draws for each tile.
    pub(super) has_clip_distances: bool,
    complaints: Complaints,
}

/// What went wrong since it was last asked for, and whether the device is lost for good.
#[derive(Clone, Debug, Default)]
struct Complaints(Arc<Mutex<(Vec<String>, Option<String>)>>);

impl Complaints {
    fn note(&self, text: String) {
        let (first, _) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // What follows from a first mistake explains nothing.
        if first.is_empty() {
            first.push(text);
        }
    }

    fn note_loss(&self, text: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).1 = Some(text);
    }

    /// The reason for the loss of the device, or the first mistake since this was last asked.
    fn take(&self) -> Option<String> {
        let (first, lost) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mistake = first.pop();
        lost.as_ref()
            .map(|reason| format!("the device is lost ({reason}); make a new renderer"))
            .or(mistake)
    }
}

impl Device {
    /// Opens an adapter with all that it allows; with `clipping`, triangles are cut at their tile's edges if it can do
    /// that.
    pub(super) fn open(adapter: &wgpu::Adapter, clipping: Clipping) -> Result<Self, String> {
        let clip = wgpu::Features::CLIP_DISTANCES;
        let features = match clipping {
            Clipping::IfPossible => adapter.features() & clip,
            #[cfg(test)]
            Clipping::Never => wgpu::Features::empty(),
        };
        let limits = adapter.limits();
        let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("driftworld"),
            required_features: features,
            required_limits: limits.clone(),
            ..Default::default()
        }));
        let (device, queue) = opened.map_err(|error| error.to_string())?;
        let complaints = Complaints::default();
        let noted = complaints.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| noted.note(explained(&error))));
        let noted = complaints.clone();
        device.set_device_lost_callback(move |reason, text| noted.note_loss(format!("{reason:?}: {text}")));
        Ok(Self {
            card: device,
            queue,
            info: adapter.get_info(),
            limits,
            has_clip_distances: features.contains(clip),
            complaints,
        })
    }

    pub(super) fn buffer(&self, label: &str, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
        self.card.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage,
            mapped_at_creation: false,
        })
    }

    /// # Errors
    /// [`EnvError::Gpu`] if anything went wrong since this was last called.
    pub(super) fn check(&self) -> Result<(), EnvError> {
        self.complaints.take().map_or(Ok(()), |reason| Err(self.failed(reason)))
    }

    pub(super) fn failed(&self, reason: String) -> EnvError {
        let adapter = self.info.name.clone();
        EnvError::Gpu { adapter, reason }
    }
}

/// Whether triangles are to be cut at the edges of their tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clipping {
    IfPossible,
    /// As on an adapter that cannot: for tests.
    #[cfg(test)]
    Never,
}

/// An error in one line.
fn explained(error: &wgpu::Error) -> String {
    let text = match error {
        wgpu::Error::OutOfMemory { .. } => "out of graphics memory".to_owned(),
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => description.clone(),
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
