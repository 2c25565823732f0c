//! `model.png`: a punch on a block with the pressure under it. Drawn, so that it is the same everywhere.

use std::io;

const SIZE: usize = 128;
const BACKGROUND: [u8; 3] = [255, 255, 255];
const PUNCH: [u8; 3] = [70, 84, 104];
const BLOCK: [u8; 3] = [190, 198, 208];
const COLD: [f64; 3] = [58.0, 110.0, 200.0];
const HOT: [f64; 3] = [214.0, 58.0, 46.0];

/// Bytes of the picture.
pub fn png() -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, SIZE as u32, SIZE as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let pixels: Vec<u8> = (0..SIZE * SIZE).flat_map(|at| pixel(at % SIZE, at / SIZE)).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels)?;
    writer.finish()?;
    Ok(bytes)
}

fn pixel(column: usize, row: usize) -> [u8; 3] {
    let x = (column as f64 + 0.5) / SIZE as f64 - 0.5;
    let y = 0.52 - (row as f64 + 0.5) / SIZE as f64;
    // Half width of the contact, and the semi-circular pressure over it.
    let half_width = 0.22;
    if y > 0.0 {
        let inside = x * x + (y - 0.62) * (y - 0.62) < 0.64 * 0.64 && y < 0.36 && x.abs() < 0.34;
        return if inside { PUNCH } else { BACKGROUND };
    }
    if !(-0.40..=0.0).contains(&y) || x.abs() > 0.44 {
        return BACKGROUND;
    }
    let pressure = (1.0 - (x / half_width) * (x / half_width)).max(0.0);
    let depth = -y / (0.30 * pressure.max(1e-9));
    if depth >= 1.0 {
        return BLOCK;
    }
    let heat = pressure * (1.0 - depth);
    std::array::from_fn(|i| (COLD[i] + (HOT[i] - COLD[i]) * heat) as u8)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_picture_is_a_png_of_its_size() {
        let bytes = super::png().expect("memory");
        let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("png");
        assert_eq!((reader.info().width, reader.info().height), (128, 128));
    }
}
