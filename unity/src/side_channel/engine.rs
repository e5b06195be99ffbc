//! Messages on the engine's configuration, read. None of them changes a world: there is no window, and time goes as fast as it
//! can.

use super::Payload;

/// What a client wants of the engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum EngineSetting {
    /// The window's width and height in pixels.
    ScreenResolution(i32, i32),
    /// A level of quality.
    QualityLevel(i32),
    /// How much faster than the clock simulated time goes.
    TimeScale(f32),
    /// Pictures a second.
    TargetFrameRate(i32),
    /// Pictures a simulated second.
    CaptureFrameRate(i32),
}

impl EngineSetting {
    /// Which one it is.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::ScreenResolution(..) => "screen resolution",
            Self::QualityLevel(_) => "quality level",
            Self::TimeScale(_) => "time scale",
            Self::TargetFrameRate(_) => "target frame rate",
            Self::CaptureFrameRate(_) => "capture frame rate",
        }
    }

    /// What becomes of it, in words.
    pub(crate) fn remark(self) -> String {
        match self {
            Self::ScreenResolution(width, height) => {
                format!(
                    "window of {width} × {height} pixels: ignored, there is no window; observation_size sets the size of observations"
                )
            }
            Self::QualityLevel(level) => format!("quality level {level}: ignored, there is one; see supersampling"),
            Self::TimeScale(scale) => format!("time scale {scale}: ignored, steps are never held back"),
            Self::TargetFrameRate(rate) => format!("target frame rate {rate}: ignored, steps are never held back"),
            Self::CaptureFrameRate(rate) => {
                format!("capture frame rate {rate}: ignored; see the environment parameter time_step")
            }
        }
    }
}

/// Reads a message.
pub(crate) fn engine_setting(bytes: &[u8]) -> Result<EngineSetting, String> {
    let mut payload = Payload::new(bytes);
    match payload.int()? {
        0 => Ok(EngineSetting::ScreenResolution(payload.int()?, payload.int()?)),
        1 => payload.int().map(EngineSetting::QualityLevel),
        2 => payload.float().map(EngineSetting::TimeScale),
        3 => payload.int().map(EngineSetting::TargetFrameRate),
        4 => payload.int().map(EngineSetting::CaptureFrameRate),
        other => Err(format!("found setting {other}, expected 0 to 4")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_read_as_clients_write_them() {
        let words = |words: &[i32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let check = |bytes: &[i32], expected: EngineSetting| assert_eq!(engine_setting(&words(bytes)), Ok(expected));
        check(&[0, 80, 60], EngineSetting::ScreenResolution(80, 60));
        check(&[1, 5], EngineSetting::QualityLevel(5));
        check(&[2, 20.0_f32.to_bits() as i32], EngineSetting::TimeScale(20.0));
        check(&[3, -1], EngineSetting::TargetFrameRate(-1));
        check(&[4, 60], EngineSetting::CaptureFrameRate(60));
        assert!(engine_setting(&words(&[5, 0])).is_err());
        assert!(engine_setting(&words(&[0, 80])).is_err());
        assert!(engine_setting(&[]).is_err());
    }
}
