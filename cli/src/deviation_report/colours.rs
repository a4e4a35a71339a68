//! The colours of deviations: blue below the surface, red above it, and cream between.
//!
//! Blue and orange stay apart for all common kinds of colour blindness, and both sides darken away from the middle.

/// From -1 to 1 in equal steps, as red, green and blue from 0 to 255; between them straight.
pub(super) const STOPS: [[u8; 3]; 9] = [
    [28, 56, 140],
    [44, 100, 176],
    [86, 150, 205],
    [165, 208, 230],
    [247, 243, 222],
    [252, 200, 125],
    [240, 132, 66],
    [205, 58, 40],
    [140, 12, 34],
];

/// The colour of a share of the scale; beyond -1 and 1 that of the end.
pub(super) fn colour(share: f64) -> [u8; 3] {
    let at = (share.clamp(-1.0, 1.0) + 1.0) / 2.0 * (STOPS.len() - 1) as f64;
    let low = (at.floor() as usize).min(STOPS.len() - 2);
    [0, 1, 2].map(|k| {
        let (from, to) = (f64::from(STOPS[low][k]), f64::from(STOPS[low + 1][k]));
        (from + (to - from) * (at - low as f64)).round() as u8
    })
}

/// A colour as CSS has it.
pub(super) fn css([red, green, blue]: [u8; 3]) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance: what is left of a colour without its hue.
    fn luminance(colour: [u8; 3]) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * linear(colour[0]) + 0.7152 * linear(colour[1]) + 0.0722 * linear(colour[2])
    }

    #[test]
    fn both_sides_darken_away_from_the_middle() {
        for step in 0..100 {
            let (here, farther) = (f64::from(step) / 100.0, f64::from(step + 1) / 100.0);
            for side in [-1.0, 1.0] {
                assert!(luminance(colour(side * farther)) < luminance(colour(side * here)), "{side} {here}");
            }
        }
        assert_eq!((colour(-7.0), colour(0.0), colour(7.0)), (STOPS[0], STOPS[4], STOPS[8]));
        assert_eq!(css([0, 15, 255]), "#000fff");
    }
}
