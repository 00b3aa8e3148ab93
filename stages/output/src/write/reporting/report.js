// Shows the turntable, and says of a place that is clicked which panel, edge and photo pixel it is.
{
  const read = id => JSON.parse(document.getElementById(id).textContent);
  const origins = read('origins'), says = document.getElementById('place');
  const viewer = turntable(document.getElementById('turntable'), read('turntable-data'));

  // The mean of the triangle's corners by their weights, from a list of x and y.
  const mix = (list, corners, weights) => [0, 1].map(k => corners.reduce((sum, c, i) => sum + weights[i] * list[2 * c + k], 0));

  function toLine(line, [x, y]) {
    let best = Infinity;
    for (let i = 0; i + 3 < line.length; i += 2) {
      const [dx, dy] = [line[i + 2] - line[i], line[i + 3] - line[i + 1]], length = dx * dx + dy * dy || 1;
      const share = Math.min(1, Math.max(0, ((x - line[i]) * dx + (y - line[i + 1]) * dy) / length));
      best = Math.min(best, Math.hypot(x - line[i] - share * dx, y - line[i + 1] - share * dy));
    }
    return best;
  }

  viewer.stage.addEventListener('toile:pick', ({ detail: { part, triangle, barycentric } }) => {
    const panel = origins[part];
    if (!panel) { says.textContent = `This is the ${part}.`; return; }
    const corners = panel.triangles.slice(3 * triangle, 3 * triangle + 3), at = mix(panel.mm, corners, barycentric);
    const nearest = panel.edges.map(([name, line]) => [toLine(line, at), name]).sort((a, b) => a[0] - b[0])[0];
    const edge = nearest ? `, ${(nearest[0] / 10).toFixed(1)} cm from the edge ${nearest[1]}` : '';
    const px = panel.px.length ? mix(panel.px, corners, barycentric).map(Math.round) : null;
    const photo = px && panel.photo ? `, pixel ${px.join(', ')} of ${panel.photo}` : '';
    says.textContent = `Panel ${part}, triangle ${triangle}${edge}${photo}.`;
  });
}
