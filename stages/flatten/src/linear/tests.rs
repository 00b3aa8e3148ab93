#![allow(clippy::unwrap_used)]
use super::*;
use crate::shapes::{bump, surface};

#[test]
fn the_order_names_every_vertex_once() {
    let s = surface(bump(20, 13, 0.5));
    let graph = Graph::new(s.positions().len(), s.triangles(), &[[0, 200]]);
    let mut order = elimination_order(&graph, s.positions());
    order.sort_unstable();
    assert!(order.iter().enumerate().all(|(k, &v)| k == v as usize));
    assert!(graph.pair(200, 0).is_some() && graph.pair(0, 199).is_none());
}

#[test]
fn a_laplacian_is_solved() {
    let s = surface(bump(12, 9, 0.5));
    let graph = Graph::new(s.positions().len(), s.triangles(), &[]);
    let order = elimination_order(&graph, s.positions());
    let n = graph.vertices();
    // Couplings of -1, and a diagonal that outweighs them by 1.
    let (starts, list) = graph.both_ways();
    let mut values = Vec::new();
    for i in 0..n {
        assert_eq!(slot(&graph, i), values.len());
        values.push(f64::from(starts[i + 1] - starts[i]) + 1.0);
        values.extend(graph.above(i).iter().map(|_| -1.0));
    }
    let exact: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
    let mut b: Vec<f64> = (0..n)
        .map(|i| {
            let near = &list[starts[i] as usize..starts[i + 1] as usize];
            (near.len() as f64 + 1.0) * exact[i] - near.iter().map(|&j| exact[j as usize]).sum::<f64>()
        })
        .collect();
    let solved = CholeskyFactor::analyse(&graph, 1, &order).and_then(|mut factor| {
        factor.factor(&values)?;
        factor.solve(&mut b)
    });
    assert_eq!(solved, Ok(()));
    assert!(b.iter().zip(&exact).all(|(x, y)| (x - y).abs() < 1e-12));
}

#[test]
fn a_matrix_that_is_not_positive_is_refused() {
    let graph = Graph::new(3, &[[0, 1, 2]], &[]);
    let order = [0, 1, 2];
    let factored = CholeskyFactor::analyse(&graph, 1, &order)
        .and_then(|mut f| f.factor(&[1.0, 5.0, 0.0, 1.0, 0.0, 1.0]));
    let error = factored.err().unwrap();
    assert!(error.to_string().starts_with("the system of 3 unknowns could not be factored ("), "{error}");
    assert_eq!(error.remedy().unwrap(), "look for slivers and remesh");
}
