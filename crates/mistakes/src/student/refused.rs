//! What the judge and the explanations are known to get wrong about correct programs.

/// Correct variants that the fair rules refuse, each with the scene, or with `probe/` and the probe scene. Tests and matrices
/// pass over these and over nothing else, and see to it that each is still refused; the goal is an empty list.
pub const KNOWN_REFUSED: &[(&str, &str)] = &[
    // A component of a contact vector that is zero by rights is compared with a bound of its own, not with one of the
    // vector's length; and so are inputs.
    ("frame-rotated", "ContinuousTimeTests/contact-exactly-at-step-start"),
    ("frame-rotated", "ContinuousTimeTests/default-restitution"),
    ("frame-rotated", "ContinuousTimeTests/impact-exactly-at-step-end"),
    ("frame-rotated", "HolisticTests/billiard-break"),
    ("frame-rotated", "probe/struck-while-falling"),
    ("frame-rotated", "probe/contact-at-start-and-end"),
    // A polynomial that is zero by rights, and holds nothing but round-off, has numbers of ordinary size after it was divided by
    // them: it needs a factor that no other polynomial has.
    ("normalised-largest", "ContinuousTimeTests/plastic-impacts-one-pass"),
    ("normalised-largest", "HalfPlaneTests/corner-with-failsafe"),
    ("normalised-largest", "HalfPlaneTests/edge-ends-land-on-a-slope"),
    ("normalised-largest", "HolisticTests/pendulum-into-a-wall-of-balls"),
    ("normalised-largest", "ImpulsesTests/plastic-impacts"),
    ("normalised-largest", "ImpulsesTests/row-of-five-one-end"),
    ("normalised-norm", "ContinuousTimeTests/impact-exactly-at-step-end"),
    ("normalised-norm", "ContinuousTimeTests/plastic-impacts-one-pass"),
    ("normalised-norm", "HalfPlaneTests/corner-with-failsafe"),
    ("normalised-norm", "HalfPlaneTests/edge-ends-land-on-a-slope"),
    ("normalised-norm", "HolisticTests/pendulum-into-a-wall-of-balls"),
    ("normalised-norm", "ImpulsesTests/plastic-impacts"),
    ("normalised-norm", "ImpulsesTests/row-of-five-one-end"),
    ("normalised-per-pair", "ContinuousTimeTests/plastic-impacts-one-pass"),
    ("normalised-per-pair", "HalfPlaneTests/edge-ends-land-on-a-slope"),
    ("normalised-per-pair", "HolisticTests/pendulum-into-a-wall-of-balls"),
    ("normalised-per-pair", "ImpulsesTests/plastic-impacts"),
    ("normalised-per-pair", "ImpulsesTests/row-of-five-one-end"),
    // Values at times within the step are nearly alike, so the higher coefficients hold their round-off many times over; the
    // polynomial is right on the whole step all the same.
    ("interpolated-all", "ContinuousTimeTests/bullet-through-thin-obstacles"),
    ("interpolated-all", "ContinuousTimeTests/fixed-obstacles"),
    ("interpolated-all", "ContinuousTimeTests/one-ball-two-edges"),
    ("interpolated-all", "HolisticTests/rope-bridge"),
    ("interpolated-all", "HolisticTests/wheel-on-a-slope"),
    ("interpolated-all", "ImpulsesTests/edge-with-one-fixed-end"),
    ("interpolated-all", "ImpulsesTests/penalty-pushes-before-impact"),
    ("interpolated-all", "probe/edges-struck"),
];

/// Correct variants that explanations accuse of something in some scene where they are asked all the same; the goal is an
/// empty list.
pub const KNOWN_ACCUSED: &[&str] = &[
    // Polynomials that hold nothing but round-off, and have ordinary numbers.
    "normalised-largest",
    "normalised-norm",
    "normalised-per-pair",
    // More round-off than the explanations allow for, and then any formula will do.
    "interpolated-all",
    "frame-shifted",
    "frame-comoving",
];
