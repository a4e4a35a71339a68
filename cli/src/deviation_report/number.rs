//! Numbers for readers.

/// How many decimals deviations are shown with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Decimals {
    Fixed(usize),
    /// Very large or very small ones have powers of ten instead.
    Scientific,
}

impl Decimals {
    /// For numbers up to about `limit`: three digits after its first.
    pub(super) fn up_to(limit: f64) -> Self {
        let decimals = 3 - limit.log10().floor() as i32;
        if (-3..=9).contains(&decimals) { Self::Fixed(decimals.max(0) as usize) } else { Self::Scientific }
    }

    pub(super) fn show(self, x: f64) -> String {
        match self {
            Self::Fixed(decimals) => without_minus_zero(format!("{x:.decimals$}")),
            Self::Scientific => format!("{x:.3e}"),
        }
    }

    /// As it stands at an axis: no more digits than the number has.
    pub(super) fn at_axis(self, x: f64) -> String {
        match self {
            Self::Fixed(decimals) => {
                let text = format!("{x:.*}", decimals + 1);
                let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
                without_minus_zero(text.to_owned())
            }
            Self::Scientific => format!("{:e}", format!("{x:.5e}").parse().unwrap_or(x)),
        }
    }
}

fn without_minus_zero(text: String) -> String {
    if text.starts_with('-') && text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.')) {
        text[1..].to_owned()
    } else {
        text
    }
}

/// `12,345`.
pub(super) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The smallest of 1, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below `x`, a positive number.
pub(super) fn round_above(x: f64) -> f64 {
    let exponent = x.log10().floor() as i32;
    // written and read, so that the result is the number that its digits name
    let named = |digits: f64| format!("{digits}e{exponent}").parse::<f64>().unwrap_or(x);
    let steps = [1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0];
    steps.into_iter().map(named).find(|round| *round >= x).unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_follow_the_size_of_the_numbers() {
        assert_eq!(Decimals::up_to(0.05).show(0.012_345_67), "0.01235");
        assert_eq!(Decimals::up_to(1.0).show(-0.000_01), "0.000");
        assert_eq!(Decimals::up_to(2500.0).show(1234.56), "1235");
        assert_eq!(Decimals::up_to(1e-9).show(1.5e-10), "1.500e-10");
        assert_eq!(Decimals::up_to(0.05).at_axis(-0.025), "-0.025");
        assert_eq!(Decimals::up_to(200.0).at_axis(100.0), "100");
        assert_eq!(Decimals::up_to(2e9).at_axis(1e9), "1e9");
    }

    #[test]
    fn limits_are_round_and_not_below() {
        let known = [(0.0411, 0.05), (1.0, 1.0), (1.2, 1.5), (0.0951, 0.1), (8.1, 10.0), (0.3, 0.3), (61.0, 80.0)];
        for (x, round) in known {
            assert_eq!(round_above(x), round);
        }
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_234_567), "1,234,567");
    }
}
