//! [`Device`]: a GPU device that records and returns errors instead of panicking.

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
    errors: ErrorLog,
}

/// The first error since the last check, and the reason if the device is lost for good.
#[derive(Clone, Debug, Default)]
struct ErrorLog(Arc<Mutex<(Vec<String>, Option<String>)>>);

impl ErrorLog {
    fn record(&self, text: String) {
        let (first, _) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        // Ignores later errors, which usually follow from the first one.
        if first.is_empty() {
            first.push(text);
        }
    }

    fn record_loss(&self, text: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).1 = Some(text);
    }

    /// The reason why the device was lost, or the first error since the last call.
    fn take(&self) -> Option<String> {
        let (first, lost) = &mut *self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let first_error = first.pop();
        lost.as_ref()
            .map(|reason| format!("the device is lost ({reason}); make a new renderer"))
            .or(first_error)
    }
}

impl Device {
    /// Opens an adapter with its full limits, and with those of the wanted features that it supports.
    pub(super) fn open(adapter: &wgpu::Adapter, wanted: wgpu::Features) -> Result<Self, String> {
        let features = adapter.features() & wanted;
        let limits = adapter.limits();
        let opened = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("driftworld"),
            required_features: features,
            required_limits: limits.clone(),
            ..Default::default()
        }));
        let (device, queue) = opened.map_err(|error| error.to_string())?;
        let errors = ErrorLog::default();
        let log = errors.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| log.record(one_line(&error))));
        let log = errors.clone();
        device.set_device_lost_callback(move |reason, text| log.record_loss(format!("{reason:?}: {text}")));
        Ok(Self {
            card: device,
            queue,
            info: adapter.get_info(),
            limits,
            has_clip_distances: features.contains(wgpu::Features::CLIP_DISTANCES),
            errors,
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
    /// [`EnvError::Gpu`] if an error was recorded since the last call.
    pub(super) fn check(&self) -> Result<(), EnvError> {
        self.errors.take().map_or(Ok(()), |reason| Err(self.failed(reason)))
    }

    pub(super) fn failed(&self, reason: String) -> EnvError {
        let adapter = self.info.name.clone();
        EnvError::Gpu { adapter, reason }
    }
}

/// An error as one line.
fn one_line(error: &wgpu::Error) -> String {
    let text = match error {
        wgpu::Error::OutOfMemory { .. } => "out of graphics memory".to_owned(),
        wgpu::Error::Validation { description, .. } | wgpu::Error::Internal { description, .. } => description.clone(),
    };
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
