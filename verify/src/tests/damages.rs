//! A thousand seeded damages beyond the limits: none is certified.

use super::*;

/// A sequence of numbers from a seed (Steele, Lea, Flood 2014: SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Damages a skirt in one of seven ways; says which.
fn damage(skirt: &mut Skirt, n: &mut Numbers) -> &'static str {
    let (columns, rows) = (skirt.columns, skirt.rows);
    let (panel, column, row) = (n.below(2), 1 + n.below(columns - 1), 1 + n.below(rows - 1));
    let inner = skirt.at(panel, column, row);
    let meshes = &mut skirt.meshes;
    match n.below(7) {
        0 => {
            let share = n.between(0.0, 0.6);
            let p = &mut meshes.positions[inner];
            (p.x, p.z) = (p.x * share, p.z * share);
            "a vertex moved into the body"
        }
        1 => {
            let share = -n.between(1.2, 2.0);
            let p = &mut meshes.positions[inner];
            (p.x, p.z) = (p.x * share, p.z * share);
            "a vertex moved through the cloth on the other side"
        }
        2 => {
            let k = n.below(meshes.triangles.len());
            meshes.triangles[k].swap(1, 2);
            if let Some(t) = &mut meshes.texture[k] {
                t.swap(1, 2);
            }
            "a triangle turned"
        }
        3 => {
            let k = n.below(meshes.triangles.len());
            meshes.triangles.remove(k);
            meshes.texture.remove(k);
            meshes.groups.remove(k);
            meshes.materials.remove(k);
            "a triangle removed"
        }
        4 => {
            let (far, turn) = (n.between(6e-4, 5e-3), n.between(0.0, 2.0 * PI));
            let v = skirt.at(panel, columns, n.below(rows + 1));
            let p = &mut skirt.meshes.positions[v];
            (p.x, p.y) = (p.x + far * turn.cos(), p.y + far * turn.sin());
            "a seam opened"
        }
        5 => {
            let factor = if n.below(2) == 0 { n.between(0.6, 0.95) } else { n.between(1.05, 1.4) };
            meshes.positions.iter_mut().for_each(|p| p.y *= factor);
            "cloth scaled along its height"
        }
        _ => {
            let far = n.between(0.1, 0.4);
            let p = &mut meshes.positions[inner];
            p.y += far;
            "a vertex moved along the cloth"
        }
    }
}

#[test]
fn a_thousand_damages_beyond_the_limits_are_never_certified() {
    let sound = Skirt::new(12, 8);
    let pattern = pattern(12);
    let body = post();
    assert!(judge(&sound.subject(Some(&pattern), Ok(body.clone())), &CheckLimits::default()).holds());
    let mut numbers = Numbers(1994);
    for case in 0..1000 {
        let mut skirt = sound.clone();
        let what = damage(&mut skirt, &mut numbers);
        let found = judge(&skirt.subject(Some(&pattern), Ok(body.clone())), &CheckLimits::default());
        assert!(!found.holds(), "case {case}: {what}: {:?}", found.checks);
    }
}
