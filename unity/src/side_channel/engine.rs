//! Reads messages about the engine's configuration. None of them has an effect: there is no window, and the simulation always runs
//! as fast as possible.

use super::Payload;

/// The name of a Unity setting, and a remark that it has no effect.
pub(crate) fn engine_setting(bytes: &[u8]) -> Result<(&'static str, String), String> {
    let mut payload = Payload::new(bytes);
    let (name, remark) = match payload.int()? {
        0 => {
            let window = format!("window of {} × {} pixels", payload.int()?, payload.int()?);
            let remark = "there is no window; observation_size sets the size of observations";
            ("screen resolution", format!("{window}: ignored, {remark}"))
        }
        1 => {
            let level = payload.int()?;
            let remark = format!("quality level {level}: ignored, there is only one; see supersampling");
            ("quality level", remark)
        }
        2 => {
            let scale = payload.float()?;
            let remark = format!("time scale {scale}: ignored, steps are never held back");
            ("time scale", remark)
        }
        3 => {
            let rate = payload.int()?;
            let remark = format!("target frame rate {rate}: ignored, steps are never held back");
            ("target frame rate", remark)
        }
        4 => {
            let rate = payload.int()?;
            let remark = format!("capture frame rate {rate}: ignored; see the environment parameter time_step");
            ("capture frame rate", remark)
        }
        other => return Err(format!("found setting {other}, expected 0 to 4")),
    };
    Ok((name, remark))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engine_settings_are_read_as_clients_write_them() {
        let words = |words: &[i32]| words.iter().flat_map(|word| word.to_le_bytes()).collect::<Vec<u8>>();
        let check = |bytes: &[i32], name: &str, begins: &str| {
            let (found, remark) = engine_setting(&words(bytes)).expect("the setting is valid");
            assert_eq!(found, name);
            assert!(remark.starts_with(&format!("{begins}: ignored")), "{remark}");
        };
        check(&[0, 80, 60], "screen resolution", "window of 80 × 60 pixels");
        check(&[1, 5], "quality level", "quality level 5");
        let scale = 20.5_f32.to_bits() as i32;
        check(&[2, scale], "time scale", "time scale 20.5");
        check(&[3, -1], "target frame rate", "target frame rate -1");
        check(&[4, 60], "capture frame rate", "capture frame rate 60");
        assert!(engine_setting(&words(&[5, 0])).is_err());
        assert!(engine_setting(&words(&[0, 80])).is_err());
        assert!(engine_setting(&[]).is_err());
    }
}
