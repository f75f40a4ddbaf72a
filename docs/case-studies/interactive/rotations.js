// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// A curve through rotations that the reader drags, its rates by the true formula and as printed. What
// is computed is in rotations.cpp.

"use strict";

duetLive.start("rotations", (host, call) => {
  const { element, figure, fixed, hue, sum, dot, cross } = duetLive;
  const count = 6;
  const samples = 301;
  const first_rows = call("first_rows", [], 4 * count).numbers;
  const state = { rows: first_rows.slice(), ends: 0, reading: 0, u: 2.4, chosen: 2 };
  let motion = [];
  let here;

  const row = (i) => state.rows.slice(4 * i, 4 * i + 4);
  const set_row = (i, q) => state.rows.splice(4 * i, 4, ...q);
  const inputs = () => [count, state.rows, state.ends, state.reading];
  /// What rotations.cpp writes of one parameter.
  const parts = (n, i) => {
    const part = (from) => n.slice(20 * i + from, 20 * i + from + 3);
    return { u: n[20 * i], q: n.slice(20 * i + 1, 20 * i + 5), mark: part(5), rates: [part(8), part(11)], printed: [part(14), part(17)] };
  };
  const degrees_between = (a, b) => (Math.atan2(Math.hypot(...cross(a, b)), dot(a, b)) * 180) / Math.PI;
  const velocity = (omega, mark) => cross(omega, mark);
  const off = (m) => degrees_between(velocity(m.rates[0], m.mark), velocity(m.printed[0], m.mark));
  const compute = () => {
    const n = call("motion_of_curve", [...inputs(), samples], 20 * samples).numbers;
    motion = Array.from({ length: samples }, (_, i) => parts(n, i));
    here = parts(call("motion_at", [...inputs(), state.u], 20).numbers, 0);
  };

  // The sphere.

  /// A body's axis turned by a rotation w, x, y, z.
  const turned = (q, v) => {
    const [w, ...u] = q;
    const c = cross(u, v);
    return v.map((x, i) => x + 2 * (w * c[i] + cross(u, c)[i]));
  };
  const space = duetLive.space({
    label: "Curve of a point of the turning body on a sphere", height: 400, centre: [0, 0, 0], radius: 1.15, azimuth: 0.12, elevation: 0.2,
    drawn: () => {
      space.ball([0, 0, 0], space.scale(), { fill: hue("rule"), "fill-opacity": 0.35, stroke: hue("rule") }, -3);
      // Meridians and parallels.
      const circle = (f, style) => {
        const points = Array.from({ length: 73 }, (_, i) => f((i * Math.PI) / 36));
        halves(points, style);
      };
      for (let k = -2; k < 4; ++k) {
        const a = (k * Math.PI) / 6;
        const style = { stroke: hue("rule"), "stroke-width": 1 };
        if (k < 3) {
          circle((t) => [Math.cos(a) * Math.cos(t), Math.cos(a) * Math.sin(t), Math.sin(a)], style);
        }
        circle((t) => [Math.cos(a) * Math.cos(t), Math.sin(a) * Math.cos(t), Math.sin(t)], style);
      }
      halves(motion.map((m) => m.mark), { stroke: hue("fg"), "stroke-width": 3 });
      // The body's y axis at rows: it shows the turn about the mark.
      for (let i = 0; i < count; ++i) {
        const p = turned(row(i), [1, 0, 0]);
        space.line([p, sum(p, turned(row(i), [0, 1, 0]), 0.16)], { stroke: hue("green"), "stroke-width": 3, opacity: is_near(p) ? 1 : 0.3 }, 0.01);
      }
      const arrows = (m, style, shift) => {
        space.arrow(m.mark, sum(m.mark, velocity(m.printed[0], m.mark), 0.5), "vermillion", style, shift);
        space.arrow(m.mark, sum(m.mark, velocity(m.rates[0], m.mark), 0.5), "blue", style, shift);
      };
      for (let i = 30; i < samples; i += 40) {
        arrows(motion[i], { opacity: is_near(motion[i].mark) ? 0.45 : 0.15 }, 1.5);
      }
      arrows(here, {}, 2);
      space.ball(here.mark, 6, { fill: hue("bg"), stroke: hue("fg"), "stroke-width": 2.5 }, 3);
      handles.forEach((handle, i) => {
        const p = turned(row(i), [1, 0, 0]);
        handle.place(p, p.map((x) => fixed(x, 2)).join(", "), i);
        handle.node.setAttribute("opacity", is_near(p) ? 1 : 0.35);
        handle.node.classList.toggle("live-selected", i === state.chosen);
      });
    },
  });
  const is_near = (p) => dot(p, space.axes().towards) >= -0.02;
  /// What is on the near side as it is, what is on the far side pale.
  const halves = (points, style) => {
    let part = [];
    let near = is_near(points[0]);
    const end = () => {
      if (part.length > 1) {
        space.line(part, near ? style : { ...style, opacity: 0.25 }, near ? 1 : -2);
      }
    };
    for (const p of points) {
      part.push(p);
      if (is_near(p) !== near) {
        end();
        near = !near;
        part = [p];
      }
    }
    end();
  };
  /// Moves the mark of a row to where a place of the view is on the sphere, on the side where it was.
  const drag_to = (i, place) => {
    const { right, up, towards } = space.axes();
    const centre = space.seen([0, 0, 0]);
    let x = (place[0] - centre[0]) / space.scale();
    let y = (centre[1] - place[1]) / space.scale();
    const r = Math.hypot(x, y);
    if (r > 1) {
      [x, y] = [x / r, y / r];
    }
    const side = is_near(turned(row(i), [1, 0, 0])) ? 1 : -1;
    const z = side * Math.sqrt(Math.max(0, 1 - x * x - y * y));
    turn_to(i, right.map((_, k) => x * right[k] + y * up[k] + z * towards[k]));
  };
  const turn_to = (i, direction) => {
    set_row(i, call("rotated_to", [row(i), direction], 4).numbers);
    redraw();
  };
  const spin = (angle) => {
    set_row(state.chosen, call("rotated_about_mark", [row(state.chosen), angle], 4).numbers);
    redraw();
  };
  const step = (i, x, y) => {
    const { right, up } = space.axes();
    const p = turned(row(i), [1, 0, 0]);
    turn_to(i, p.map((v, k) => v + 0.05 * (x * right[k] + y * up[k])));
  };
  const choose = (i) => {
    if (state.chosen !== i) {
      state.chosen = i;
      chosen();
      redraw();
    }
  };
  const handles = Array.from({ length: count }, (_, i) =>
    space.handle({
      label: `Orientation ${i}: where its mark is on the sphere`, colour: "fg", text: String(i), focus: () => choose(i), drag: (place) => drag_to(i, place),
      keys: {
        ArrowLeft: () => step(i, -1, 0), ArrowRight: () => step(i, 1, 0), ArrowUp: () => step(i, 0, 1), ArrowDown: () => step(i, 0, -1),
        PageUp: () => spin(0.1), PageDown: () => spin(-0.1),
      },
    }));

  // Rates.

  const axes = ["x", "y", "z"];
  const rate = (symbol, unit, k, i) =>
    duetLive.plot({ label: `<i>${symbol}<sub>${axes[i]}</sub></i> [${unit}]`, height: i === 2 ? 136 : 120, x_label: i === 2 ? "u" : "", choose: (u) => set_u(u) });
  const plots = [0, 1, 2].map((i) => [rate("ω", "rad", 0, i), rate("α", "rad", 1, i)]);
  const draw_rates = () => {
    for (const k of [0, 1]) {
      // The same scale for all three components, by the true rates; the printed ones may leave it.
      const values = motion.flatMap((m) => m.rates[k]);
      const printed = motion.flatMap((m) => m.printed[k]);
      const size = Math.max(...values.map(Math.abs));
      const shown = Math.min(Math.max(...printed.map(Math.abs), size), 2.2 * size) * 1.05;
      for (let i = 0; i < 3; ++i) {
        const line = (of, colour) => ({ points: motion.map((m) => [m.u, m[of][k][i]]), colour });
        plots[i][k].draw({ x: [0, count - 1], y: [-shown, shown], lines: [line("printed", "vermillion"), line("rates", "blue")], at: state.u });
      }
    }
  };

  // Controls.

  const u_slider = duetLive.slider({
    label: "Parameter u", min: 0, max: count - 1, step: 0.01, value: state.u, text: (u) => fixed(u, 2),
    change: (u) => set_u(u),
  });
  const set_u = (u) => {
    state.u = u;
    u_slider.set(u);
    redraw();
  };
  let spun = 0;
  const turn = duetLive.slider({
    label: "", min: -180, max: 180, step: 1, value: 0, text: (a) => fixed(a, 0) + "°",
    change: (a) => {
      spin(((a - spun) * Math.PI) / 180);
      spun = a;
    },
  });
  const chosen = () => {
    turn.set(0);
    turn.node.querySelector("label").textContent = `Turn of dot ${state.chosen} about its mark`;
    spun = 0;
  };
  const reading = duetLive.choice({
    label: "Printed formula", names: ["functions from B₀", "functions from B₋₁", "basis corrected, commuting"], value: 0,
    change: (i) => {
      state.reading = i;
      redraw();
    },
  });
  const ends = duetLive.choice({
    label: "Ends of the curve", names: ["not-a-knot", "natural"], value: 0,
    change: (i) => {
      state.ends = i;
      redraw();
    },
  });
  const reset = element("button", { type: "button", onclick: () => {
    state.rows = first_rows.slice();
    chosen();
    redraw();
  } }, "Back to the first rows");

  const says = element("p", { class: "live-says" });
  const say = () => {
    const worst = motion.reduce((a, b) => (off(b) > off(a) ? b : a));
    says.innerHTML = `Here, at u = ${fixed(state.u, 2)}, the printed velocity is off by <b>${fixed(off(here), 1)}°</b>; at most by <b>${fixed(off(worst), 1)}°</b>, at u = ${fixed(worst.u, 2)}.`;
  };
  const draw = () => {
    compute();
    space.redraw();
    draw_rates();
    say();
  };
  const redraw = duetLive.once_per_frame(draw);

  host.append(
    element("div", { class: "live-controls" }, u_slider.node, turn.node, reading.node, ends.node),
    says,
    element("div", { class: "live-figures" },
      figure([duetLive.legend([["blue", "true formula"], ["vermillion", "as printed"], ["green", "the body's y axis"]]), space.node, reset],
        "A point of a turning body (the mark) draws a curve on the sphere, through six orientations. Drag the dots, or choose one and use the arrow keys, Page Up and Page Down; drag the sphere to look from elsewhere. Its velocity at u must be tangent to the curve: by the true formula (blue) it is."),
      figure([element("div", { class: "live-multiples" }, ...plots.flat().map((p) => p.node))],
        "Angular velocity ω (left) and angular acceleration α (right) of the curve over u, in axes that stay, per unit of u: true (blue) and as printed (vermillion). Where only blue is seen both agree. Drag across to choose u."),
    ),
  );
  chosen();
  draw();
});
