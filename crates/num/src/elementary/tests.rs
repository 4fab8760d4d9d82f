use super::{cos, exp, ln, sin};

#[test]
fn exact_arguments_have_exact_values() {
    assert_eq!(exp(0.0).to_bits(), 1.0_f64.to_bits());
    assert_eq!(exp(f64::NEG_INFINITY).to_bits(), 0.0_f64.to_bits());
    assert_eq!(exp(f64::INFINITY), f64::INFINITY);
    assert_eq!([exp(1000.0), exp(-1000.0)], [f64::INFINITY, 0.0]);
    assert_eq!(ln(1.0).to_bits(), 0.0_f64.to_bits());
    assert_eq!([ln(0.0), ln(-0.0), ln(f64::INFINITY)], [f64::NEG_INFINITY, f64::NEG_INFINITY, f64::INFINITY]);
    assert_eq!(sin(-0.0).to_bits(), (-0.0_f64).to_bits());
    assert_eq!(cos(0.0).to_bits(), 1.0_f64.to_bits());
    for nan in [exp(f64::NAN), ln(f64::NAN), ln(-1.0), sin(f64::NAN), sin(f64::INFINITY), cos(f64::NEG_INFINITY)] {
        assert!(nan.is_nan());
    }
}

#[test]
fn the_rotation_by_94_degrees_has_the_bits_of_the_specification() {
    let angle = 94.0 * 0.017_453_293;
    assert_eq!(cos(angle).to_bits(), 0xBFB1_DB90_2EC1_47E0);
    assert_eq!(sin(angle).to_bits(), 0x3FEF_EC0B_6FC0_5F20);
}

/// On machines with the GNU C library and with fused operations, the bits must be the same. `FOSSSIM_ARGUMENTS` sets
/// how many arguments of each kind are tried.
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
#[test]
fn the_bits_are_those_of_the_gnu_c_library() {
    if !std::arch::is_x86_feature_detected!("fma") {
        return;
    }
    let count = std::env::var("FOSSSIM_ARGUMENTS").map_or(100_000, |count| count.parse().expect("a number"));
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut bits = move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    // The number is between 0 and 1.
    let unit = |bits: u64| (bits >> 11) as f64 / 9_007_199_254_740_992.0;
    for _ in 0..count {
        let any = f64::from_bits(bits());
        let sign = if bits() & 1 == 0 { 1.0 } else { -1.0 };
        let small = sign * unit(bits());
        let around = |center: f64, width: f64| center + width * small;
        // The arguments are all bit patterns, turns, the limits of subnormal and infinite results, and numbers near
        // one.
        for x in [any, 4.0 * small, 1e3 * small, 1e9 * small, around(-720.0, 30.0), around(1.0, 0.1), 1e-309 * small] {
            for (name, ours, theirs) in
                [("exp", exp(x), x.exp()), ("ln", ln(x), x.ln()), ("sin", sin(x), x.sin()), ("cos", cos(x), x.cos())]
            {
                let same = ours.to_bits() == theirs.to_bits() || ours.is_nan() && theirs.is_nan();
                assert!(same, "{name}({x:e}, {:#x}): {ours:e}, the library's is {theirs:e}", x.to_bits());
            }
        }
    }
}
