// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// An arm whose tip is dragged along a screw motion to a goal that the reader moves. What is computed is
// in arm.cpp.

"use strict";

duetLive.start("arm", (host, call) => {
  const { element, shape, figure, fixed, short, hue, sum, dot } = duetLive;
  const arms = [
    { name: "Panda", centre: [0.15, 0.05, 0.42], goal: [-0.1, 0.4, 0.12, 0.2, -0.5, 0.9] },
    { name: "UR5e", centre: [-0.25, 0, 0.35], goal: [0.1, 0.5, 0.15, 0.4, -0.3, 0.7] },
    { name: "LBR iiwa 14", centre: [0.15, 0.05, 0.48], goal: [-0.15, 0.45, -0.1, 0.2, -0.5, 0.9] },
  ];
  const reasons = ["", "a joint is at its limit", "the arm is in a singular position", "", "steps became too small", "it took too many steps"];
  const out_of_reach = 6;
  const room = 2000;
  const solution_room = 16;
  const on_screw = 61;
  const state = { arm: 0, start: [], by: [], tau: 0.5 };
  let joints;
  let lower;
  let upper;
  let start_pose;
  let goal;
  let screw;
  let way;
  let plan;
  let solutions;
  let here;

  const place = (pose) => pose.slice(4);
  const degrees = (x, digits = 0) => fixed((x * 180) / Math.PI, digits) + "°";
  const poses = (numbers) => Array.from({ length: numbers.length / 7 }, (_, i) => numbers.slice(7 * i, 7 * i + 7));
  const links = (theta) => poses(call("links_of_arm", [state.arm, theta], 7 * (joints + 2)).numbers);
  /// A pose's axes, by its rotation w, x, y, z.
  const axes_of = ([w, x, y, z]) => [
    [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
    [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
    [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
  ];

  // What is computed.

  /// The arm's coordinates at τ, as far as the plan goes.
  const joints_at = (tau) => {
    const last = plan.length - 1;
    const i = plan.findIndex((w) => w.tau > tau);
    if (i <= 0) {
      return plan[i < 0 ? last : 0].joints;
    }
    const [a, b] = [plan[i - 1], plan[i]];
    const part = (tau - a.tau) / (b.tau - a.tau);
    return a.joints.map((x, k) => x + part * (b.joints[k] - x));
  };
  const set_arm = (arm, from) => {
    state.arm = arm;
    const { numbers, returned } = call("joints_of_arm", [arm], 21);
    joints = returned;
    lower = numbers.slice(0, joints);
    upper = numbers.slice(joints, 2 * joints);
    state.start = from || numbers.slice(2 * joints, 3 * joints);
    state.by = from ? [0, 0, 0, 0, 0, 0] : arms[arm].goal.slice();
    turns.forEach((turn, i) => turn.set((state.by[3 + i] * 180) / Math.PI));
    start_links = links(state.start);
    start_pose = start_links[joints + 1];
    space.look_at(arms[arm].centre);
    make_bars();
  };
  let start_links;
  const compute = () => {
    goal = call("moved_pose", [start_pose, state.by], 7).numbers;
    const n = call("screw_between", [start_pose, goal, on_screw], 9 + 7 * on_screw).numbers;
    screw = { axis: n.slice(0, 3), point: n.slice(3, 6), angle: n[6], translation: n[7], turns: n[8] === 1 };
    way = poses(n.slice(9)).map(place);
    const p = call("plan_of_arm", [state.arm, state.start, goal, room], 3 + (1 + joints) * room);
    plan = Array.from({ length: Math.min(p.returned, room) }, (_, i) => {
      const from = 3 + (1 + joints) * i;
      return { tau: p.numbers[from], joints: p.numbers.slice(from + 1, from + 1 + joints) };
    });
    plan.reason = p.numbers[0];
    plan.end = plan[plan.length - 1].tau;
    const s = call("solutions_of_arm", [state.arm, goal, plan[plan.length - 1].joints, solution_room], solution_room * joints);
    solutions = Array.from({ length: s.returned }, (_, i) => {
      const theta = s.numbers.slice(joints * i, joints * (i + 1));
      return { joints: theta, links: links(theta) };
    });
    const count = 41;
    plan.singular = Array.from({ length: count }, (_, i) => {
      const tau = (plan.end * i) / (count - 1);
      return [tau, call("singular_values_of_arm", [state.arm, joints_at(tau)], 6).numbers];
    });
  };
  const move = () => {
    const theta = joints_at(state.tau);
    here = { joints: theta, links: links(theta), singular: call("singular_values_of_arm", [state.arm, theta], 6).numbers };
  };

  // The arm.

  const space = duetLive.space({
    label: "The arm, its tip's way and the goal", height: 430, centre: arms[0].centre, radius: 0.7, azimuth: -0.9, elevation: 0.35,
    drawn: () => {
      for (let i = -3; i <= 3; ++i) {
        const style = { stroke: hue("rule"), "stroke-width": 1 };
        space.line([[i / 6, -0.5, 0], [i / 6, 0.5, 0]], style, -5);
        space.line([[-0.5, i / 6, 0], [0.5, i / 6, 0]], style, -5);
      }
      draw_arm(start_links, "rule", "bg", -3);
      solutions.forEach((s) => draw_arm(s.links, "muted", "rule", -2));
      draw_arm(here.links, "fg", "sky", 0);
      const tip = here.links[joints + 1];
      triad(tip, 0.09, 1);
      triad(goal, 0.12, 1);
      if (screw.turns) {
        const end = (s) => sum(screw.point, screw.axis, s);
        space.line([end(-0.5), end(0.5)], { stroke: hue("purple"), "stroke-width": 2, "stroke-dasharray": "7 4" });
      }
      const stop = Math.round(plan.end * (on_screw - 1));
      space.line(way.slice(stop), { stroke: hue("vermillion"), "stroke-width": 3, "stroke-dasharray": "2 6" }, 1);
      space.line(way.slice(0, stop + 1), { stroke: hue("blue"), "stroke-width": 3 }, 1);
      goal_handle.place(place(goal), place(goal).map((x) => fixed(x, 2)).join(", ") + " metres");
      tip_handle.place(place(tip), "τ = " + fixed(Math.min(state.tau, plan.end), 2), fixed(state.tau, 2));
    },
  });
  const draw_arm = (frames, edge, colour, shift) => {
    const points = frames.map(place);
    const width = 0.075 * space.scale();
    points.slice(1).forEach((p, i) => {
      const from = points[i];
      if (Math.hypot(...sum(p, from, -1)) > 1e-6) {
        space.line([from, p], { stroke: hue(edge), "stroke-width": width }, shift);
        space.line([from, p], { stroke: hue(colour), "stroke-width": width - 2.5 }, shift + 1e-4);
      }
    });
    points.slice(1, -1).forEach((p) => space.ball(p, 0.2 * width, { fill: hue(edge) }, shift + 0.04));
  };
  const triad = (pose, size, shift) => {
    ["vermillion", "green", "blue"].forEach((colour, i) => {
      const p = place(pose);
      space.line([p, sum(p, axes_of(pose)[i], size)], { stroke: hue(colour), "stroke-width": 3 }, shift);
    });
  };
  const goal_by = (x, y) => {
    const { right, up } = space.axes();
    right.forEach((r, k) => (state.by[k] += x * r + y * up[k]));
    redraw();
  };
  const goal_handle = space.handle({
    label: "Goal", colour: "orange",
    drag: ([x, y]) => {
      const [gx, gy] = space.seen(place(goal));
      goal_by((x - gx) / space.scale(), (gy - y) / space.scale());
    },
    keys: { ArrowLeft: () => goal_by(-0.02, 0), ArrowRight: () => goal_by(0.02, 0), ArrowUp: () => goal_by(0, 0.02), ArrowDown: () => goal_by(0, -0.02) },
  });
  const tip_handle = space.handle({
    label: "Tip, along the screw", colour: "blue",
    drag: ([x, y]) => {
      const far = way.map((p) => {
        const [px, py] = space.seen(p);
        return Math.hypot(px - x, py - y);
      });
      // Between the nearest and its nearer neighbour by their distances.
      const i = far.indexOf(Math.min(...far));
      set_tau(Math.min(i / (on_screw - 1), plan.end));
    },
    keys: { ArrowLeft: () => tau_by(-0.02), ArrowDown: () => tau_by(-0.02), ArrowRight: () => tau_by(0.02), ArrowUp: () => tau_by(0.02), Home: () => set_tau(0), End: () => set_tau(1) },
  });

  // Limits.

  const bars = element("div", {});
  let marks = [];
  const make_bars = () => {
    marks = lower.map((_, i) => ({
      range: element("span", { class: "live-range" }),
      mark: element("span", { class: "live-mark" }),
      text: element("output", {}),
    }));
    bars.replaceChildren(...marks.map((m, i) =>
      element("div", { class: "live-bar" },
        element("span", {}, "θ" + "₁₂₃₄₅₆₇"[i]),
        element("span", { class: "live-track" },
          element("small", {}, degrees(lower[i])), element("small", {}, degrees(upper[i])), m.range, m.mark),
        m.text)));
  };
  const draw_bars = () => {
    marks.forEach((m, i) => {
      const part = (x) => (100 * (x - lower[i])) / (upper[i] - lower[i]);
      const used = plan.map((w) => part(w.joints[i]));
      const [low, high] = [Math.min(...used), Math.max(...used)];
      const now = part(here.joints[i]);
      m.range.style.left = low + "%";
      m.range.style.width = high - low + "%";
      m.mark.style.left = now + "%";
      m.mark.classList.toggle("live-at-limit", now < 2 || now > 98);
      m.text.textContent = degrees(here.joints[i], 1);
    });
  };

  // Singular values.

  const singular = duetLive.plot({ label: "Singular values of the Jacobian", height: 190, log: true, x_label: "τ", choose: (tau) => set_tau(tau) });
  const draw_singular = () => {
    const lines = [0, 1, 2, 3, 4, 5].map((k) => ({
      points: plan.singular.map(([tau, s]) => [tau, Math.max(s[k], 1e-9)]), colour: k === 5 ? "vermillion" : "blue",
    }));
    const low = Math.min(...plan.singular.map(([, s]) => s[5]));
    singular.draw({ x: [0, 1], y: [Math.max(-6, Math.min(-2, Math.floor(Math.log10(low)))), 1], lines, at: Math.min(state.tau, plan.end) });
  };

  // Solutions.

  const list = element("div", {});
  const draw_solutions = () => {
    if (!solutions.length) {
      list.replaceChildren(element("p", {}, "No joint coordinates were found that take the tip to the goal."));
      return;
    }
    const heads = ["", ...lower.map((_, i) => "θ" + "₁₂₃₄₅₆₇"[i])];
    const t = duetLive.table(heads, solutions.map((_, i) => String(i + 1)));
    t.set(solutions.map((s) => s.joints.map((x) => degrees(x))));
    list.replaceChildren(t.node, element("p", { class: "live-note" }, joints === 6
      ? "All joint coordinates within the limits that take the tip to the goal, by all_inverse_kinematics."
      : "Joint coordinates that take the tip to the goal. Of seven joints there are curves of them; this one is what inverse_kinematics finds from where the plan ends."));
  };

  // Controls.

  const arm = duetLive.choice({
    label: "Arm", names: arms.map((a) => a.name), value: 0,
    change: (i) => {
      set_arm(i);
      redraw();
    },
  });
  const tau = duetLive.slider({
    label: "Along the screw, τ", min: 0, max: 1, step: 0.01, value: state.tau, text: (x) => fixed(x, 2),
    change: (x) => set_tau(x),
  });
  const set_tau = (x) => {
    state.tau = Math.min(1, Math.max(0, x));
    tau.set(state.tau);
    redraw_tip();
  };
  const tau_by = (x) => set_tau(Math.min(state.tau, plan.end) + x);
  const turns = ["x", "y", "z"].map((axis, i) =>
    duetLive.slider({
      label: `Turn of the goal, ${axis}`, min: -180, max: 180, step: 1, value: 0, text: (x) => fixed(x, 0) + "°",
      change: (x) => {
        state.by[3 + i] = (x * Math.PI) / 180;
        redraw();
      },
    }));
  const buttons = element("div", { class: "live-buttons" },
    element("button", { type: "button", onclick: () => {
      const from = here.joints.slice();
      set_arm(state.arm, from);
      set_tau(0);
      redraw();
    } }, "Go on from here"),
    element("button", { type: "button", onclick: () => {
      set_arm(state.arm);
      set_tau(0.5);
      redraw();
    } }, "Begin again"));

  const says = element("p", { class: "live-says" });
  const say = () => {
    const kind = !screw.turns ? `Straight on by <b>${fixed(1000 * screw.translation, 0)} mm</b>, without a turn`
      : `A screw by <b>${degrees(screw.angle)}</b> about the dashed axis and <b>${fixed(1000 * screw.translation, 0)} mm</b> along it`;
    says.innerHTML = kind + (plan.reason === 0 ? ": the goal is reached."
      : plan.reason === out_of_reach ? ": the goal is out of reach."
      : `: the plan ends at <b>τ = ${fixed(plan.end, 2)}</b>, as ${reasons[plan.reason]}.`);
  };
  const draw_tip = () => {
    move();
    space.redraw();
    draw_bars();
    draw_singular();
  };
  const draw = () => {
    compute();
    draw_tip();
    draw_solutions();
    say();
  };
  const redraw = duetLive.once_per_frame(draw);
  const redraw_tip = duetLive.once_per_frame(draw_tip);

  host.append(
    element("div", { class: "live-controls" }, arm.node, tau.node),
    element("div", { class: "live-controls", style: "--least: 180px" }, ...turns.map((t) => t.node)),
    says,
    element("div", { class: "live-figures" },
      figure([space.node, buttons],
        "The arm on its way (blue), where it starts and where it may end (pale). Drag the orange dot to move the goal, the blue one along the screw; both obey the arrow keys. What is dotted in vermillion the arm cannot follow. Drag elsewhere to look from another side."),
      element("div", {},
        figure([bars], "Every joint between its limits: the mark is where it is, the bar what the whole plan uses of its range. A mark turns vermillion close to a limit."),
        figure([singular.node], "Singular values of the tip's Jacobian along the plan (metres and radians, frame: the base's axes at the tip), on a logarithmic scale; the smallest is vermillion. Where it falls to zero the tip cannot move in some direction. Drag across to move the tip."),
        list),
    ),
  );
  set_arm(0);
  draw();
});
