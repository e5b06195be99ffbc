//! Recorded episodes: reading, replaying and rendering.

use std::path::PathBuf;
use std::sync::Arc;

use driftworld::film::{FilmOptions, film, named, write_film};
use driftworld::recordings::RecordedEpisodes;
use driftworld_env::{Catalogue, EndedBy, EpisodeOrigin, Recording};
use driftworld_metrics::Record;
use driftworld_report::picture::Picture;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray3};
use pyo3::exceptions::{PyMemoryError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};
use serde_json::json;

use crate::classes::catalogue;
use crate::document::Whole;
use crate::errors::{Error, Result, wrong};
use crate::json::to_py;
use crate::rounding::detach;

/// Maximum bytes of frames per call.
const MAX_FRAME_BYTES: usize = 1 << 34;

/// A recorded episode.
#[pyclass(name = "RecordingHandle", module = "driftworld._native", frozen)]
pub(crate) struct PyRecording(pub(crate) Arc<Recording>);

impl From<Recording> for PyRecording {
    fn from(recording: Recording) -> Self {
        Self(Arc::new(recording))
    }
}

impl PyRecording {
    /// The same recording, as the episode of a log's row.
    pub(crate) fn of_row(&self, row: &Record) -> Recording {
        Recording {
            origin: EpisodeOrigin {
                experience: row.exp_num,
                block: Some(row.block_num),
                ..self.0.origin.clone()
            },
            ..Recording::clone(&self.0)
        }
    }
}

/// Options for rendering an episode, as words.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Shown {
    view: String,
    modality: String,
    size: u32,
    every: u32,
    captions: bool,
    renderer: String,
    libraries: Vec<Vec<u8>>,
}

impl Shown {
    fn options(&self) -> Result<(FilmOptions, Catalogue)> {
        let catalogue = catalogue(&self.libraries)?;
        let options = FilmOptions {
            view: word("view", named(&self.view))?,
            modality: word("modality", named(&self.modality))?,
            size: self.size,
            fps: None,
            every: self.every,
            captions: self.captions,
            renderer: self.renderer.parse()?,
        };
        Ok((options, catalogue))
    }
}

fn word<T>(option: &str, read: std::result::Result<T, String>) -> PyResult<T> {
    read.map_err(|error| PyValueError::new_err(format!("{option}: {error}")))
}

#[pymethods]
impl PyRecording {
    /// The episode's identity and results, as a dictionary.
    fn about<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let (recording, origin) = (&self.0, &self.0.origin);
        let about = json!({
            "experience": origin.experience, "block": origin.block, "task": origin.task, "variant": origin.variant,
            "seed": origin.seed, "index": origin.index, "recorded_by": recording.recorded_by,
            "steps": recording.actions.len(), "reward": recording.reward, "ended_by": recording.ended_by.map(EndedBy::word),
            "edits": recording.edits.len(), "seconds_per_step": recording.seconds_per_step(),
        });
        Ok(to_py(py, &about)?)
    }

    /// The JSON of its initial world.
    fn world(&self) -> String {
        self.0.world.to_json()
    }

    /// The actions: rows of the action table as int64 `(steps,)`, or numbers as float64 `(steps, 3)`.
    fn actions<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let rows: Option<Vec<i64>> = (self.0.actions.iter())
            .map(|action| Some(action.row()? as i64))
            .collect();
        if let Some(rows) = rows.filter(|rows| !rows.is_empty()) {
            return Ok(PyArray1::from_vec(py, rows).into_any());
        }
        let numbers = self.0.actions.iter().flat_map(|action| action.raw_numbers());
        let numbers = PyArray1::from_iter(py, numbers);
        Ok(numbers.reshape([self.0.actions.len(), 3])?.into_any())
    }

    /// The frames, uint8 `(frames, height, width, 3)`; replays the episode, which must match the recording.
    fn frames<'py>(&self, py: Python<'py>, shown: Shown) -> Result<Bound<'py, PyAny>> {
        let (options, catalogue) = shown.options()?;
        let num_frames = options.num_frames(self.0.actions.len());
        let expected = num_frames * (options.size as usize).pow(2) * 6;
        if expected > MAX_FRAME_BYTES {
            return Err(PyMemoryError::new_err(format!(
                "frames: found {num_frames} of {} pixels, expected at most {} GiB in all; show fewer (every=…), make them smaller, or \
                 write a file",
                options.size,
                MAX_FRAME_BYTES >> 30
            ))
            .into());
        }
        let (pixels, size) = detach(py, || {
            let (mut pixels, mut size) = (Vec::new(), [0, 0]);
            film(&self.0, &catalogue, &options, &mut |picture, _| {
                size = [picture.height as usize, picture.width as usize];
                pixels.extend_from_slice(&picture.rgb);
                Ok(())
            })?;
            Ok::<_, Error>((pixels, size))
        })?;
        let frames = PyArray1::from_vec(py, pixels);
        Ok(frames.reshape([num_frames, size[0], size[1], 3])?.into_any())
    }

    /// Writes a film or a sheet; returns its number of frames, its size in pixels and its duration in seconds.
    fn write(&self, py: Python<'_>, path: PathBuf, shown: Shown, fps: Option<f64>) -> Result<(u32, u32, u32, f64)> {
        let (options, catalogue) = shown.options()?;
        let options = FilmOptions { fps, ..options };
        let film = detach(py, || write_film(&path, &self.0, &catalogue, &options, &mut |_| {}))?;
        Ok((film.frames, film.height, film.width, film.seconds))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let text =
            driftworld_env::RecordingLines::header() + &driftworld_env::RecordingLines::default().lines(&slf.get().0);
        Ok((slf.get_type().getattr("from_text")?, PyTuple::new(slf.py(), [text])?))
    }

    /// Parses a recording.
    #[staticmethod]
    fn from_text(text: &str) -> Result<Self> {
        let mut reader = driftworld_env::RecordingReader::new(text.as_bytes())?;
        let episode = reader.next_episode()?;
        let episode = episode.ok_or_else(|| PyValueError::new_err("recording: found no episode, expected one"))?;
        Ok(Self::from(reader.recording(&episode)?))
    }
}

/// The recording of an episode in a log, or in a file of recordings; it is compared with its row in the log.
#[pyfunction]
pub(crate) fn read_recording(
    py: Python<'_>,
    path: PathBuf,
    episode: Whole,
    worker: Option<&str>,
) -> Result<PyRecording> {
    let worker = worker.map(str::to_owned);
    let recording = detach(py, || {
        let mut episodes = RecordedEpisodes::open(&path)?;
        let recording = episodes.recording(episode.0, worker.as_deref())?;
        let recording = recording.ok_or_else(|| episodes.unrecorded(episode.0))?;
        episodes.check_row(&recording, worker.as_deref())?;
        Ok::<_, Error>(recording)
    })?;
    Ok(PyRecording::from(recording))
}

/// Encodes an image, uint8 `(height, width, 3)`, as PNG.
#[pyfunction]
pub(crate) fn png<'py>(py: Python<'py>, picture: PyReadonlyArray3<'py, u8>) -> Result<Bound<'py, PyBytes>> {
    let picture = picture.as_array();
    let (height, width, _) = picture.dim();
    let picture = Picture {
        width: width as u32,
        height: height as u32,
        rgb: picture.iter().copied().collect(),
    };
    Ok(PyBytes::new(py, &picture.to_png().map_err(wrong)?))
}
