// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// The wheel carrier: errors of splines through tables of its orientation. What is computed is in
// wheel_carrier.cpp.

"use strict";

duetLive.start("wheel_carrier", (host, call) => {
  const { element, figure, fixed, short, hue } = duetLive;
  const tables = [6, 8, 10, 14, 18, 25, 35, 50, 70, 105, 140, 200, 280, 400];
  const kinds = ["cumulative, the paper's", "rotation-vector cubic", "rotation-vector quintic", "Hermite, by all rates"];
  const ends = ["natural", "not-a-knot", "velocities (clamped)", "accelerations", "both"];
  const state = { rows: 105, kind: 0, ends: 2, u: 0.05 };
  const lowest = -0.19;
  const highest = 0.2;

  const data = call("hardpoints_of_carrier", [], 33).numbers;
  const vector = (numbers, i) => numbers.slice(i, i + 3);
  const centre = vector(data, 0);
  const on_chassis = [0, 1, 2, 3, 4].map((i) => vector(data, 3 + 6 * i));

  // Controls.

  const rows = duetLive.slider({
    label: "Rows of the table", min: 0, max: tables.length - 1, step: 1, value: tables.indexOf(state.rows),
    text: (i) => String(tables[i]),
    change: (i) => {
      state.rows = tables[i];
      redraw();
    },
  });
  const kind = duetLive.choice({
    label: "Spline", names: kinds, value: state.kind,
    change: (i) => {
      state.kind = i;
      offer_ends();
      redraw();
    },
  });
  const end = duetLive.choice({
    label: "Ends", names: ends, value: state.ends,
    change: (i) => {
      state.ends = i;
      redraw();
    },
  });
  const offer_ends = () => {
    // Only a quintic can be told both; Hermite's spline has no ends to be told.
    const offered = state.kind === 2 ? ends : ends.slice(0, 4);
    state.ends = Math.min(state.ends, offered.length - 1);
    end.set(offered, state.ends);
    end.input.disabled = state.kind === 3;
  };
  const height_text = (u) => fixed(1000 * u, 0) + " mm";
  const height = duetLive.slider({
    label: "Height u", min: lowest, max: highest, step: 0.005, value: state.u, text: height_text,
    change: (u) => set_height(u),
  });
  const set_height = (u) => {
    state.u = u;
    height.set(u);
    redraw_height();
  };

  // The carrier, seen from behind and above.

  const space = duetLive.space({
    label: "The wheel carrier on its five rods", height: 330, centre: [0.17, 0.72, 0.03], radius: 0.41, half_width: 0.58, azimuth: -1.95, elevation: 0.25,
    drawn: () => {
      const n = call("carrier_at", [state.u], 35).numbers;
      const w = vector(n, 0);
      const [ahead, left, up] = [18, 21, 24].map((i) => vector(n, i));
      const wheel = (radius, out) =>
        Array.from({ length: 65 }, (_, i) => {
          const a = (i * Math.PI) / 32;
          return w.map((x, k) => x + radius * (Math.cos(a) * ahead[k] + Math.sin(a) * up[k]) + out * left[k]);
        });
      for (const out of [-0.085, 0.085]) {
        space.face(wheel(0.31, out), { fill: hue("rule"), "fill-opacity": 0.35, stroke: hue("muted"), "stroke-width": 1.5 }, out > 0 ? 0.1 : 0);
      }
      const held = [0, 1, 2, 3, 4].map((i) => vector(n, 3 + 3 * i));
      held.forEach((p, i) => {
        space.line([w, p], { stroke: hue("muted"), "stroke-width": 7 }, 0.2);
        space.line([on_chassis[i], p], { stroke: hue("fg"), "stroke-width": 4 }, 0.21);
        space.ball(p, 5, { fill: hue("bg"), stroke: hue("fg"), "stroke-width": 2 }, 0.22);
        space.ball(on_chassis[i], 5, { fill: hue("fg") }, 0.22);
      });
      space.ball(w, 6, { fill: hue("blue") }, 0.23);
      space.line(way, { stroke: hue("blue"), "stroke-width": 2 }, 0.23);
      const degrees = (x) => fixed((x * 180) / Math.PI, 2) + "°";
      says.innerHTML = `At u = ${height_text(state.u)}: toe-in <b>${degrees(n[27])}</b>, camber <b>${degrees(n[28])}</b>.`;
    },
  });
  const way = Array.from({ length: 40 }, (_, i) =>
    vector(call("carrier_at", [lowest + ((highest - lowest) * i) / 39], 35).numbers, 0));
  const says = element("p", { class: "live-says" });

  // Errors.

  const velocity = duetLive.plot({ label: "Error of the angular velocity, <i>δ<sub>E</sub></i> [%]", height: 200, log: true, choose: (u) => set_height(u) });
  const acceleration = duetLive.plot({ label: "Error of the angular acceleration, <i>dδ<sub>E</sub></i> [%]", height: 216, log: true, x_label: "u [m]", choose: (u) => set_height(u) });
  const name = (d, what) => [element("i", {}, d + "δ", element("sub", {}, "E")), " " + what];
  const errors = duetLive.table(["percent", "median", "largest", "at u"], [
    name("", "true"), name("", "printed"), name("d", "true"), name("d", "printed")]);
  const rates = duetLive.table(["at this u", "mechanism", "spline", "printed"], [
    [element("i", {}, "|δ|"), " [rad/m]"], [element("i", {}, "|δ′|"), " [rad/m²]"]]);

  const decades = (values) => {
    const logs = values.filter((x) => x > 0).map(Math.log10);
    const high = Math.ceil(Math.max(...logs));
    return [Math.min(high - 2, Math.max(Math.floor(Math.min(...logs)), high - 12)), high];
  };
  /// Steps from row to row, at the largest value between.
  const steps = (u, values) => {
    const points = [];
    values.forEach((y, i) => {
      if (y > 0) {
        points.push([u[i], y], [u[i + 1], y]);
      }
    });
    return points;
  };
  const spline = () => [state.rows, state.kind, state.kind === 3 ? 0 : state.ends];
  let lines;
  const draw_errors = () => {
    const r = state.rows;
    const n = call("errors_of_spline", spline(), 12 + r + 4 * (r - 1)).numbers;
    const u = n.slice(12, 12 + r);
    const curves = [0, 1, 2, 3].map((i) => n.slice(12 + r + i * (r - 1), 12 + r + (i + 1) * (r - 1)));
    const printed = state.kind === 0;
    const both = (truth, print) => ({
      y: decades(printed ? [...truth, ...print] : truth),
      lines: [
        ...(printed ? [{ points: steps(u, print), colour: "vermillion" }] : []),
        { points: steps(u, truth), colour: "blue" },
      ],
    });
    lines = [both(curves[0], curves[2]), both(curves[1], curves[3])];
    // Smaller ones are partly rounding.
    const percent = (x, least, least_text) => (x < least ? "< " + least_text : short(x));
    const row = (i) => {
      const least = i % 6 ? [1e-4, "10⁻⁴"] : [1e-6, "10⁻⁶"];
      return [percent(n[i], ...least), percent(n[i + 1], ...least), fixed(1000 * n[i + 2], 0) + " mm"];
    };
    const none = ["–", "–", "–"];
    errors.set([row(0), printed ? row(6) : none, row(3), printed ? row(9) : none]);
    draw_height();
  };
  const draw_height = () => {
    space.redraw();
    [velocity, acceleration].forEach((plot, i) => plot.draw({ x: [lowest, highest], ...lines[i], at: state.u }));
    const exact = call("carrier_at", [state.u], 35).numbers;
    const s = call("rates_at", [...spline(), state.u], 12).numbers;
    const size = (numbers, i) => short(Math.hypot(...vector(numbers, i)), 5);
    const printed = (i) => (state.kind === 0 ? size(s, i) : "–");
    rates.set([
      [size(exact, 29), size(s, 0), printed(6)],
      [size(exact, 32), size(s, 3), printed(9)],
    ]);
  };
  const redraw = duetLive.once_per_frame(draw_errors);
  const redraw_height = duetLive.once_per_frame(draw_height);

  host.append(
    element("div", { class: "live-controls" }, rows.node, kind.node, end.node, height.node),
    element("div", { class: "live-figures" },
      figure([duetLive.legend([["blue", "true formula"], ["vermillion", "as printed"]]), velocity.node, acceleration.node],
        "How wrong the spline's angular velocity (above) and angular acceleration (below) are against the mechanism's own: the largest error between any two rows, one step from row to row, on a logarithmic scale. The printed formula is for the cumulative B-spline. Drag across to choose the height."),
      element("div", {},
        figure([space.node, says],
          "The carrier on its five rods, with the way of the wheel's centre as the wheel rises and falls (blue). Filled ends of rods are on the chassis, open ones on the carrier. Drag to look from elsewhere."),
        errors.node, rates.node),
    ),
  );
  offer_ends();
  draw_errors();
});
