//! Numbers in pictures: digits of 3 x 5 dots.

use image::{Rgb, RgbImage};

/// The rows of each digit from the top, three bits a row.
const DIGITS: [[u8; 5]; 10] = [
    [0b111, 0b101, 0b101, 0b101, 0b111],
    [0b010, 0b110, 0b010, 0b010, 0b111],
    [0b111, 0b001, 0b111, 0b100, 0b111],
    [0b111, 0b001, 0b111, 0b001, 0b111],
    [0b101, 0b101, 0b111, 0b001, 0b001],
    [0b111, 0b100, 0b111, 0b001, 0b111],
    [0b111, 0b100, 0b111, 0b101, 0b111],
    [0b111, 0b001, 0b010, 0b010, 0b010],
    [0b111, 0b101, 0b111, 0b101, 0b111],
    [0b111, 0b101, 0b111, 0b001, 0b111],
];

/// Height of a digit in pixels.
pub const HEIGHT: u32 = 5 * DOT;

/// Edge of a dot in pixels.
const DOT: u32 = 2;

/// Columns of dots from one character to the next.
const ADVANCE: u32 = 4;

fn rows(character: char) -> [u8; 5] {
    match character {
        '-' => [0, 0, 0b111, 0, 0],
        '.' => [0, 0, 0, 0, 0b010],
        _ => character.to_digit(10).map_or([0; 5], |digit| DIGITS[digit as usize]),
    }
}

/// Draws a number with its middle at `middle` and its top at `top`; what lies beyond the picture is left out.
pub fn draw(picture: &mut RgbImage, text: &str, middle: u32, top: u32, colour: Rgb<u8>) {
    let width = (text.chars().count() as u32 * ADVANCE).saturating_sub(1) * DOT;
    let left = middle.saturating_sub(width / 2);
    for (character, at) in text.chars().zip((left..).step_by((ADVANCE * DOT) as usize)) {
        for (bits, row) in rows(character).into_iter().zip(0_u32..) {
            for column in (0..3).filter(|column| bits >> (2 - column) & 1 == 1) {
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let (x, y) = (at + column * DOT + dx, top + row * DOT + dy);
                    if let Some(pixel) = picture.get_pixel_mut_checked(x, y) {
                        *pixel = colour;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(text: &str) -> String {
        let mut picture = RgbImage::new(40, 10);
        draw(&mut picture, text, 19, 0, Rgb([255; 3]));
        let dot = |x, y| if picture.get_pixel(x, y).0[0] > 0 { '#' } else { ' ' };
        let row =
            |y: u32| (0..20_u32).map(|x| dot(2 * x, 2 * y)).collect::<String>().trim_end().to_owned() + "\n";
        (0..5_u32).map(row).collect()
    }

    #[test]
    fn a_number_can_be_read() {
        assert_eq!(
            drawn("4-7."),
            "  # #     ###\n  # #       #\n  ### ###  #\n    #      #\n    #      #   #\n"
        );
    }

    #[test]
    fn every_digit_has_a_shape_of_its_own() {
        let shapes: std::collections::BTreeSet<_> = DIGITS.iter().collect();
        assert_eq!(shapes.len(), 10);
    }

    #[test]
    fn what_does_not_fit_is_left_out() {
        draw(&mut RgbImage::new(3, 3), "123456789", 1, 1, Rgb([255; 3]));
    }
}
