//! Converts observations to the protocol's form: images of depth, colours and segmentation, then the state vector.

use driftworld_env::{Frame, category_color, depth_to_gray};

use crate::client::Client;
use crate::error::UnityError;
use crate::protocol::{CompressionTypeProto, FloatData, ObservationData, ObservationProto};

/// The form in which images are sent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureForm {
    /// As PNG files, as Unity sends them.
    #[default]
    Png,
    /// As floats in 0..1.
    Floats,
}

/// Properties of a dimension, for clients using protocol version 1.5 or later: none, or translational equivariance (rows and
/// columns of images).
const NO_NEIGHBOURS: i32 = 1;
const NEIGHBOURS: i32 = 2;

/// The channels of an image: red, green, blue.
const CHANNELS: usize = 3;

/// Distance in metres at which depth is white, as in [`depth_to_gray`]: much nearer than the sky.
const WHITE_DEPTH: f32 = 100.0;

/// The observations of a frame and a state, in the order used by the original environment.
///
/// `state` begins with the number of the collected or photographed object.
pub(crate) fn observations(
    frame: &Frame,
    state: Vec<f32>,
    form: PictureForm,
    client: Client,
) -> Result<Vec<ObservationProto>, UnityError> {
    let size = [frame.width, frame.height];
    let compressed = |rgb: &[u8]| png(size, rgb).map(ObservationData::CompressedData);
    let floats = |data| {
        let data = ordered(data, client);
        Ok(ObservationData::FloatData(FloatData { data }))
    };
    let share = |byte: &u8| f32::from(*byte) / 255.0;
    let colors = |rgb: &[u8]| match form {
        PictureForm::Png => compressed(rgb),
        PictureForm::Floats => floats(rgb.iter().map(share).collect()),
    };
    let depth = match form {
        PictureForm::Png => compressed(&tripled(depth_to_gray(&frame.depth)))?,
        PictureForm::Floats => {
            let share = |metres: &f32| (metres / WHITE_DEPTH).clamp(0.0, 1.0);
            floats(tripled(frame.depth.iter().map(share)))?
        }
    };
    let categories = frame.category.iter();
    let categories: Vec<u8> = categories.flat_map(|category| category_color(*category)).collect();
    Ok(vec![
        visual("depth", frame, depth, client),
        visual("rgb", frame, colors(&frame.rgb)?, client),
        visual("segmentation", frame, colors(&categories)?, client),
        vector(state),
    ])
}

/// Repeats a single-channel image in three channels.
fn tripled<T: Copy>(values: impl IntoIterator<Item = T>) -> Vec<T> {
    values.into_iter().flat_map(|value| [value; CHANNELS]).collect()
}

/// Orders floats as the client expects them: channels last, or first.
fn ordered(floats: Vec<f32>, client: Client) -> Vec<f32> {
    if !client.channels_first {
        return floats;
    }
    (0..CHANNELS)
        .flat_map(|channel| floats.iter().skip(channel).step_by(CHANNELS).copied())
        .collect()
}

fn visual(name: &str, frame: &Frame, data: ObservationData, client: Client) -> ObservationProto {
    let [height, width, channels] = [frame.height as i32, frame.width as i32, CHANNELS as i32];
    let (shape, dimension_properties) = if client.channels_first {
        ([channels, height, width], [NO_NEIGHBOURS, NEIGHBOURS, NEIGHBOURS])
    } else {
        ([height, width, channels], [NEIGHBOURS, NEIGHBOURS, NO_NEIGHBOURS])
    };
    let compression_type = match data {
        ObservationData::CompressedData(_) => CompressionTypeProto::Png,
        ObservationData::FloatData(_) => CompressionTypeProto::None,
    };
    ObservationProto {
        shape: shape.to_vec(),
        compression_type: compression_type.into(),
        dimension_properties: dimension_properties.to_vec(),
        name: name.to_owned(),
        observation_data: Some(data),
    }
}

fn vector(state: Vec<f32>) -> ObservationProto {
    ObservationProto {
        shape: vec![state.len() as i32],
        compression_type: CompressionTypeProto::None.into(),
        dimension_properties: vec![NO_NEIGHBOURS],
        name: "state".to_owned(),
        observation_data: Some(ObservationData::FloatData(FloatData { data: state })),
    }
}

/// Encodes 8-bit RGB as PNG with fast compression, because the file is decoded a millisecond later.
pub(crate) fn png([width, height]: [u32; 2], rgb: &[u8]) -> Result<Vec<u8>, UnityError> {
    let failed = |error: png::EncodingError| UnityError::Picture(error.to_string());
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::Fastest);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(rgb).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn float_depth_equals_png_grey_before_rounding() {
        let metres = vec![0.0, 0.1, 33.3, 99.9, 100.0, 1000.0];
        let mut frame = Frame::new(metres.len() as u32, 1);
        frame.depth.clone_from(&metres);
        let observations =
            observations(&frame, Vec::new(), PictureForm::Floats, Client::default()).expect("floats need no encoding");
        let Some(ObservationData::FloatData(FloatData { data })) = &observations[0].observation_data else {
            panic!("expected floats: {:?}", observations[0]);
        };
        assert_eq!(data[..9], [0.0, 0.0, 0.0, 0.001, 0.001, 0.001, 0.333, 0.333, 0.333]);
        for (float, gray) in data.iter().step_by(CHANNELS).zip(depth_to_gray(&metres)) {
            assert!((float * 255.0 - f32::from(gray)).abs() < 0.501, "{float}: {gray}");
        }
    }
}
