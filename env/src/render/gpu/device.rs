//! [`Device`]: a GPU device that never panics: errors are recorded and returned.

use std::sync::{Arc, Mutex, PoisonError};

use crate::EnvError;

/// A device with its queue, its limits and its recorded errors.
#[derive(Debug)]
pub(super) struct Device {
    pub(super) card: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) info: wgpu::AdapterInfo,
    pub(super) limits: wgpu::Limits,
    /// Whether triangles can be clipped at the edges of their tile; otherwise each tile is drawn separately.
    pub(super) has_clip_distances: bool,
    complaints: Complaints,
}

/// The first error since the last check, and the reason if the device is lost for good.
#[derive(Clone, Debug, Default)]
struct Complaints(Arc<Mutex<(Vec<String>, Option<String>)>>);

impl Complaints {
    fn note(&self, text: String) {
        let (first, _) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // Errors that follow from the first one explain nothing.
        if first.is_empty() {
            first.push(text);
        }
    }

    fn note_loss(&self, text: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).1 = Some(text);
    }

    /// The reason why the device was lost, or the first error since the last call.
    fn take(&self) -> Option<String> {
        let (first, lost) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mistake = first.pop();
        lost.as_ref()
            .map(|reason| format!("the device is lost ({reason}); make a new renderer"))
            .or(mistake)
    }
}

impl Device {
    /// Opens an adapter with its full limits; with `clipping`, triangles are clipped at their tile's edges if supported.
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

/// Whether to clip triangles at the edges of their tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Clipping {
    IfPossible,
    /// As on an adapter without support; for tests.
    #[cfg(test)]
    Never,
}

/// An error as one line.
fn explained(error: &wgpu::Error) -> String {
    let text = match error {
        wgpu::Error::OutOfMemory { .. } => "out of graphics memory".to_owned(),
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => description.clone(),
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
