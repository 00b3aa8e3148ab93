#![allow(clippy::unwrap_used)]
use super::*;

fn close(got: f64, wanted: f64, relative: f64) {
    assert!((got / wanted - 1.0).abs() <= relative, "{got} is not {wanted}");
}

#[test]
fn elastica_limits() {
    let light = cantilever(1e-3);
    close(light.drop, 1e-3 / 8.0, 1e-3);
    close(light.tip_angle, 1e-3 / 6.0, 1e-3);
    let heavy = cantilever(1e4);
    close(heavy.reach, (2.0 / 1e4_f64).sqrt(), 2e-2);
    close(heavy.drop, 1.0 - (8.0_f64.sqrt() - 2.0) / 2e4_f64.sqrt(), 1e-3);
    // ASTM D1388: overhang of twice the bending length at 41.5 degrees, exactly 2.00035.
    let gamma = root(5.0, 12.0, |g| {
        let e = cantilever(g);
        e.drop.atan2(e.reach).to_degrees() - 41.5
    });
    close(gamma.cbrt(), 2.00035, 1e-5);
}

#[test]
fn elastica_agrees_with_a_second_method() {
    // Collocation with 4,000 nodes by an independent program.
    for (gamma, drop, reach) in [
        (8.0, 0.6406307174, 0.7244247341),
        (100.0, 0.9375239354, 0.1592233826),
        (1e3, 0.9811412693, 0.0459864548),
    ] {
        close(cantilever(gamma).drop, drop, 1e-8);
        close(cantilever(gamma).reach, reach, 1e-8);
    }
}

#[test]
fn catenary_limits() {
    let shallow = catenary(0.999, 0.0);
    close(shallow.sag, (0.375_f64 * 0.999 * 0.001).sqrt(), 2e-3);
    close(catenary(1e-6, 0.0).sag, 0.5, 1e-4);
    close(catenary(0.8, 0.1).sag, 0.29573653042, 1e-9);
}

#[test]
fn hanging_strip_limits() {
    close(hanging_stvk(1e-5), 5e-6, 2e-5);
    close(hanging_stvk(1.0), 0.3053593066, 1e-8);
    let curve = [[0.05, 1.5], [0.10, 5.0], [0.20, 40.0]];
    close(hanging_piecewise(&curve, 0.3 * 9.81, 1.5), 0.05524943813, 1e-9);
}

#[test]
fn off_axis_limits() {
    let o = Orthotropic::SAMPLES[1];
    close(o.stiffness_at(0.0), o.e1, 1e-12);
    close(o.stiffness_at(std::f64::consts::FRAC_PI_2), o.e2, 1e-12);
    close(Orthotropic::SAMPLES[0].stiffness_at(45_f64.to_radians()), 113.8519924, 1e-9);
    close(Orthotropic::SAMPLES[3].stiffness_at(0.7), 500.0, 1e-12);
}

#[test]
fn plate_coefficients_of_timoshenko() {
    close(supported_plate(), 0.00406235, 1e-6);
    close(clamped_plate().unwrap(), 0.00126532, 2e-4);
}

#[test]
fn frequencies_of_the_books() {
    close(bessel_zero(1), 2.404825557695773, 1e-12);
    close(hanging_omega(2), 2.760039055, 1e-9);
    close(membrane_frequency(1.0, 1.0, 1.0, 4.0, 1.0), 2.0_f64.sqrt(), 1e-12);
    close((-1000.0 * backward_euler_loss(1.0, 0.1)).exp(), 1.01_f64.powf(-500.0), 1e-9);
}

#[test]
fn heart_loop_of_peirce() {
    close(heart_loop(0.0).value, 0.133860372, 1e-7);
    // Peirce's formula: with t = 32.85 degrees (l - l0) / l0 the bending length is l0 (cos t / tan
    // t)^(1/3).
    for gamma in [5.0, 20.0, 80.0] {
        let loops = heart_loop(gamma);
        let t = (32.85 * (loops.value - 0.1337) / 0.1337_f64).to_radians();
        close(0.1337 * (t.cos() / t.tan()).cbrt(), gamma.cbrt().recip(), 0.03);
        let (first, last) = (loops.places[0], loops.places[loops.places.len() - 1]);
        assert!((first[0] - last[0]).abs() < 1e-9 && (first[1] - last[1]).abs() < 1e-9);
    }
}

#[test]
fn columns_slip_where_the_books_say() {
    // Little pressed: tan k = k, and with m the ratio of forces y = m (x - sin(k x) / (k cos k)),
    // shortening = integral of y'²/2.
    let (small, k) = (pressed_column(1e-3), 4.493409457909064_f64);
    let slope =
        |m: f64| super::integral(0.0, 1.0, 400, |x| 0.5 * (m * (1.0 - (k * x).cos() / k.cos())).powi(2));
    close(small.value, (1e-3 / slope(1.0)).sqrt(), 2e-2);
    assert!(pressed_column(0.3).value > pressed_column(0.1).value);
}

#[test]
fn pendulum_limits() {
    close(plate_pendulum(1e-4), 2.0 * std::f64::consts::PI * (2.0_f64 / 3.0).sqrt(), 1e-8);
    // 60 degrees: 7.32 % slower.
    close(plate_pendulum(std::f64::consts::FRAC_PI_3) / plate_pendulum(1e-6), 1.0731820, 1e-6);
}

#[test]
fn a_swing_without_stretch_is_bessels() {
    let (stiff, exact) = (hanging_swing(0.0), hanging_omega(1));
    assert!((stiff.omega / exact - 1.0).abs() < 1e-6, "{}", stiff.omega);
    let j0 =
        |x: f64| integral(0.0, std::f64::consts::PI, 200, |t| (x * t.sin()).cos()) / std::f64::consts::PI;
    for s in [0.0, 0.013, 0.25, 0.5, 0.99, 1.0_f64] {
        let wanted = j0(bessel_zero(1) * s.sqrt());
        assert!((stiff.at(s) - wanted).abs() < 1e-5, "{s}: {} against {wanted}", stiff.at(s));
    }
    // Soft cloth hangs lower and swings slower, at first by what Rayleigh's quotient of the stiff
    // shape predicts.
    let mode = |s: f64| j0(bessel_zero(1) * s.sqrt());
    let rise = |s: f64| (mode(s + 1e-4) - mode(s - 1e-4)) / 2e-4;
    let loss = integral(1e-3, 1.0, 100, |s| s * s * rise(s).powi(2))
        / integral(1e-3, 1.0, 100, |s| s * rise(s).powi(2));
    let soft = hanging_swing(1e-3).omega / stiff.omega - 1.0;
    assert!((soft / (-0.5 * 1e-3 * loss) - 1.0).abs() < 0.01, "{soft}, {loss}");
}
