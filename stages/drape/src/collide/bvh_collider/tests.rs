#![allow(clippy::unwrap_used, clippy::expect_used)]

use super::super::testing::{both, cube, sheet, sphere};
use super::*;

fn made(collider: &BvhCollider, body: Option<&Body>) -> Arc<dyn Collide> {
    collider.run(body, &Context::quiet()).unwrap().scheme
}

fn with(contact: ContactSettings) -> BvhCollider {
    BvhCollider { contact, ..Default::default() }
}

const VOLUMES: [Volume; 7] = [
    Volume::Aabb,
    Volume::Sphere,
    Volume::Obb,
    Volume::KDop(6),
    Volume::KDop(14),
    Volume::KDop(18),
    Volume::KDop(26),
];

#[test]
fn tells_the_distance_to_a_sphere_inside_and_outside() {
    let ball = sphere(0.5, 64, 128);
    let at = [0.3, 0.499, 0.501, 0.51, 0.6].map(|r| Point3::new(0.0, 0.0, r));
    for volume in VOLUMES {
        let scheme = made(&BvhCollider { volume, ..Default::default() }, Some(&ball));
        let mut contacts = Vec::new();
        scheme.body_contacts(&at, 0.02, &mut contacts);
        assert_eq!(contacts.iter().map(|c| c.vertex).collect::<Vec<_>>(), [0, 1, 2, 3], "{volume:?}");
        for (contact, expected) in contacts.iter().zip([-0.2, -0.001, 0.001, 0.01]) {
            // The facets lie up to 0.6 mm under the sphere.
            assert!((contact.distance - expected).abs() < 7e-4, "{volume:?}: {contact:?}");
            assert!(contact.normal.z > 0.999, "{volume:?}: {contact:?}");
        }
    }
}

#[test]
fn all_volumes_give_the_same_bits() {
    let ball = sphere(0.5, 32, 64);
    let wave = |lift: f64| sheet(20, move |x, y| 0.02 * (9.0 * x).sin() * (7.0 * y).cos() + lift);
    let (positions, triangles) = both(wave(0.1), wave(0.108));
    let answers: Vec<_> = VOLUMES
        .iter()
        .map(|&volume| {
            let scheme = made(&BvhCollider { volume, ..Default::default() }, Some(&ball));
            let (mut on_body, mut on_self) = (Vec::new(), Vec::new());
            scheme.body_contacts(&positions, 0.05, &mut on_body);
            scheme.self_contacts(&positions, &triangles, 0.01, &mut on_self);
            let bounds = scheme.conservative_bounds(&positions, &triangles, 0.02);
            (on_body, on_self, bounds, scheme.self_crossings(&positions, &triangles))
        })
        .collect();
    assert!(answers[0].0.len() > 100 && answers[0].1.len() > 400);
    assert!(answers.iter().all(|a| *a == answers[0]));
}

#[test]
fn refuses_polytopes_that_do_not_exist() {
    let error = BvhCollider { volume: Volume::KDop(7), ..Default::default() }
        .run(Some(&cube(0.5)), &Context::quiet())
        .unwrap_err();
    assert_eq!(error.message, "`volume` is KDop(7), and there is no such polytope");
    assert_eq!(error.hint.as_deref(), Some("k is 6, 14, 18 or 26"));
    assert_eq!((error.code, error.param), (ErrorCode::InvalidParameter, Some("volume")));
}

#[test]
fn refuses_an_open_body() {
    let mut open = cube(0.5);
    open.triangles.pop();
    let error = BvhCollider::default().run(Some(&open), &Context::quiet()).unwrap_err();
    assert_eq!(
        error.message,
        "the body is not closed: it has 3 boundary edges, the first from (0.500, -0.500, -0.500) to (0.500, -0.500, 0.500) m"
    );
}

#[test]
fn warns_where_nothing_is_left_to_collide() {
    let cx = Context::quiet();
    with(ContactSettings { self_collision: false, ..Default::default() }).run(None, &cx).unwrap();
    assert_eq!(
        cx.take_remarks().warnings,
        ["there is no body and self-collision is off: nothing is kept apart"]
    );
}

#[test]
fn a_bridge_needs_armpits_and_keeps_cloth_out_of_the_gap() {
    let wide = with(ContactSettings { bridge: Length::mm(80.0), ..Default::default() });
    let cx = Context::quiet();
    wide.run(Some(&cube(0.5)), &cx).unwrap();
    assert_eq!(
        cx.take_remarks().notes,
        ["`bridge` has nothing to bridge: there is no body with landmarks of its armpits"]
    );
    let lengths = "(height: \"172 cm\", bust: \"88 cm\", waist: \"70 cm\", hip: \"96 cm\")";
    let body = toile_fixtures::mannequin(lengths).unwrap();
    let (over, plain) = (made(&wide, Some(&body)), made(&BvhCollider::default(), Some(&body)));
    let [over_skin, skin] = [&over, &plain].map(|c| c.surface().unwrap().positions.to_vec());
    let way = |(p, q): (&Point3, &Point3)| (*p, q - p);
    let ways = skin.iter().zip(&over_skin).map(way);
    let (from, by) = ways.max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap();
    // Half-way up from the crease to the skin that is led over it: outside the body, and nowhere
    // for cloth.
    let halfway = from + 0.5 * by;
    let far = |c: &Arc<dyn Collide>| {
        let mut contacts = Vec::new();
        c.body_contacts(&[halfway], 0.1, &mut contacts);
        contacts[0].distance
    };
    assert!(far(&plain) > 1e-3 && far(&over) < -1e-3, "{} {}", far(&plain), far(&over));
}

#[test]
fn its_signature_tells_bodies_and_settings_apart() {
    let sign = |c: &BvhCollider, b: Option<&Body>| c.run(b, &Context::quiet()).unwrap().signature;
    let plain = BvhCollider::default();
    let rough = with(ContactSettings { friction: 0.5, ..Default::default() });
    let signs = [
        sign(&plain, None),
        sign(&plain, Some(&cube(0.5))),
        sign(&plain, Some(&cube(0.6))),
        sign(&rough, Some(&cube(0.5))),
    ];
    assert_eq!(signs.iter().collect::<std::collections::BTreeSet<_>>().len(), 4);
    assert_eq!(signs[1], sign(&plain, Some(&cube(0.5))));
}

#[test]
fn its_card_shows_the_settings() {
    let settings = ContactSettings {
        thickness: Length::mm(2.0),
        penalty: Some(Penalty::Linear(50.0)),
        ..Default::default()
    };
    let card = made(&with(settings), None).card();
    assert_eq!(
        card,
        ColliderCard {
            thickness: 0.002,
            friction: 0.3,
            restitution: 0.0,
            self_collision: true,
            penalty: Some(Penalty::Linear(50.0))
        }
    );
}
