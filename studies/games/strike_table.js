// Reads a strike table: cuefem strike FILE --format table -o table.json. Speed m/s; offset b/R, positive to the right.
// clamped: the speed is beyond the table's, whose nearest row is read; miscue: the ball leaves as at the miscue limit.
function strike(table, speed, offset) {
  const { speed: rows, share: columns, limit: limits } = table;
  const row = Math.min(Math.max(speed, rows[0]), rows[rows.length - 1]);
  const cell = (lines, at) => Math.min(Math.max(lines.findIndex(line => line >= at) - 1, 0), lines.length - 2);
  const j = cell(rows, row), t = Math.log(row / rows[j]) / Math.log(rows[j + 1] / rows[j]);
  const limit = (1 - t) * limits[j] + t * limits[j + 1];
  const held = Math.min(Math.max(offset, -limit), limit);
  const share = Math.abs(held) / limit, i = cell(columns, share);
  const s = (share - columns[i]) / (columns[i + 1] - columns[i]);
  const across = values => (1 - s) * values[i] + s * values[i + 1];
  const read = field => (1 - t) * across(table[field][j]) + t * across(table[field][j + 1]);
  return {
    squirt: held * read("squirt_over_offset"),
    ball_speed: speed * read("speed_ratio"),
    spin: held * read("spin_over_offset") * speed / table.ball.radius,
    miscue: held !== offset,
    clamped: row !== speed,
  };
}
if (typeof module !== "undefined") module.exports = strike;
