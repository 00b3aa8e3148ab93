//! Queries the body for the distance of each node. Cost: one query per node that may be near.

use super::BodyContact;
use crate::contact::collision_surface::CollisionSurface;
use crate::statics::forces::distance_query::{ContactQuery, DistanceCache, NEAR};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

impl BodyContact {
    /// Queries the body for each node. Cached distances save the search, or narrow it.
    pub(crate) fn query(&self, body: &dyn CollisionSurface, x: &[Vec3]) -> Vec<ContactQuery> {
        let reach = |(i, p): (usize, &Vec3)| {
            let within = self.offsets[i] + self.depth;
            self.distance_cache.get(i).map_or(Some(within), |c| c.reach(p, self.offsets[i], within))
        };
        let within: Vec<Option<f64>> = x.iter().enumerate().map(reach).collect();
        let asked: Vec<usize> = (0..x.len()).filter(|&i| within[i].is_some()).collect();
        let points: Vec<Vec3> = asked.iter().map(|&i| x[i]).collect();
        let reach: Vec<f64> = asked.iter().filter_map(|&i| within[i]).collect();
        let mut found = body.nearest(&points, &reach).into_iter();
        let one = |(i, p): (usize, &Vec3)| match (within[i], self.distance_cache.get(i)) {
            (None, Some(cached)) => (*cached, None),
            (reach, _) => match found.next().flatten() {
                Some(n) => {
                    let cached = DistanceCache { at: *p, distance: n.distance, exact: true };
                    (cached, (n.distance < NEAR * self.offsets[i]).then_some(n))
                }
                None => (DistanceCache { at: *p, distance: reach.unwrap_or(0.0), exact: false }, None),
            },
        };
        x.iter().enumerate().map(one).collect()
    }
}
