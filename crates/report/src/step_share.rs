//! Describes how many steps are right or wrong, in words that all reports use.

/// Returns text such as `all 15 steps are right` or `the only step is right`. `format_count` formats numbers.
pub fn describe_right_steps(steps: u32, format_count: fn(u64) -> String) -> String {
    match steps {
        0 => "there are no steps, so no step can be wrong".to_owned(),
        1 => "the only step is right".to_owned(),
        steps => format!("all {} steps are right", format_count(steps.into())),
    }
}

/// Returns text such as `3 of 15 steps are wrong`, `1 of 15 steps is wrong` or `the only step is wrong`. `format_count`
/// formats numbers.
pub fn describe_wrong(wrong: u64, steps: u32, format_count: fn(u64) -> String) -> String {
    match (wrong, steps) {
        (1, 1) => "the only step is wrong".to_owned(),
        (wrong, steps) => {
            let verb = if wrong == 1 { "is" } else { "are" };
            format!("{} of {} steps {verb} wrong", format_count(wrong), format_count(steps.into()))
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn one_step_is_not_many() {
        let count = |number: u64| number.to_string();
        assert_eq!(super::describe_right_steps(1, count), "the only step is right");
        assert_eq!(super::describe_right_steps(2, count), "all 2 steps are right");
        assert_eq!(super::describe_wrong(1, 1, count), "the only step is wrong");
        assert_eq!(super::describe_wrong(1, 2, count), "1 of 2 steps is wrong");
        assert_eq!(super::describe_wrong(2, 2, count), "2 of 2 steps are wrong");
    }
}
