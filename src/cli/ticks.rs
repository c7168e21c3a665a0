//! The numbers beside a scale.

/// Round numbers from zero to at most `most`, four to ten steps apart; none where there is nothing
/// to tell apart.
pub(super) fn ticks(most: f32) -> impl Iterator<Item = f32> {
    let step = step(most);
    (0..=10_u8).map(move |i| f32::from(i) * step).take_while(move |&n| n <= most)
}

/// The step from number to number: 1, 2 or 5 times a power of ten, so that there are four to ten of
/// them. Infinite where there is nothing to tell apart.
fn step(most: f32) -> f32 {
    let rough = most / 10.0;
    // Far below any length that a picture could tell apart, tenths are nothing.
    if !(rough >= f32::MIN_POSITIVE && rough.is_finite()) {
        return f32::INFINITY;
    }
    let power = 10.0_f32.powf(rough.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|&step| step >= rough).unwrap_or(steps[3])
}

/// A number in four digits.
pub(super) fn short(number: f64) -> String {
    if number == 0.0 {
        return "0".to_owned();
    }
    if !(1e-3..1e6).contains(&number) {
        return format!("{number:.2e}");
    }
    #[expect(clippy::cast_possible_truncation, reason = "a small number of digits")]
    #[expect(clippy::cast_sign_loss, reason = "it is not negative")]
    let decimals = (3.0 - number.log10().floor()).max(0.0) as usize;
    let text = format!("{number:.decimals$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (most, expected) in [(27.2, 5.0), (10.0, 1.0), (0.31, 0.05), (4000.0, 500.0)]
        {
            assert!((step(most) / expected - 1.0).abs() < 1e-5, "{most}: {}", step(most));
        }
        assert!(step(0.0).is_infinite());
        for bits in 0..200 {
            assert!(ticks(f32::from_bits(bits << 16)).count() <= 11);
            assert!(ticks(f32::from_bits(bits)).all(f32::is_finite) || bits == 0);
        }
    }

    #[test]
    fn numbers_are_short() {
        let texts =
            [0.0, 2.0, 0.125, 12.345_67, 123_456.7, 1.5e-5, 2e9, 1e100].map(short);
        assert_eq!(
            texts,
            ["0", "2", "0.125", "12.35", "123457", "1.50e-5", "2.00e9", "1.00e100"]
        );
    }
}
