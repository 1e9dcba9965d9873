// Reads a strike table: cuefem strike FILE --format table -o table.json. Speed m/s; offset b/R, positive to the right.
function strike(table, speed, offset) {
  const rows = table.speed, columns = table.share;
  const last = rows.length - 1;
  if (!(speed >= rows[0] && speed <= rows[last])) throw new RangeError(`speed must be ${rows[0]} to ${rows[last]} m/s`);
  const cell = (lines, at) => Math.min(Math.max(lines.findIndex(line => line >= at) - 1, 0), lines.length - 2);
  const j = cell(rows, speed), t = Math.log(speed / rows[j]) / Math.log(rows[j + 1] / rows[j]);
  const u = Math.abs(offset) / ((1 - t) * table.limit[j] + t * table.limit[j + 1]);
  const inside = Math.min(u, 1), i = cell(columns, inside), s = (inside - columns[i]) / (columns[i + 1] - columns[i]);
  const row = values => (1 - s) * values[i] + s * values[i + 1];
  const read = field => (1 - t) * row(table[field][j]) + t * row(table[field][j + 1]);
  const [squirt, spin] = [offset * read("squirt_over_offset"), offset * read("spin_over_offset") * speed / table.ball.radius];
  return { squirt, ball_speed: speed * read("speed_ratio"), spin, miscue: u > 1 };
}
if (typeof module !== "undefined") module.exports = strike;
