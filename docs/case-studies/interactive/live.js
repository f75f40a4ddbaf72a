// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// What the live pages share: they start, call duet, and draw. Colours are in live.css.

"use strict";

window.duetLive = (() => {
  const pages = {};

  // Elements.

  const fill = (node, attributes, children) => {
    for (const [name, value] of Object.entries(attributes || {})) {
      if (name.startsWith("on")) {
        node.addEventListener(name.slice(2), value);
      } else if (value !== undefined) {
        node.setAttribute(name, value);
      }
    }
    node.append(...children);
    return node;
  };
  const element = (tag, attributes, ...children) =>
    fill(document.createElement(tag), attributes, children);
  const shape = (tag, attributes, ...children) =>
    fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

  // Numbers as text.

  const minus = (text) => text.replace(/-/g, "−");
  const raised = (n) => minus(String(n)).replace(/[−0-9]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["−0123456789".indexOf(c)]);
  const fixed = (x, digits) => minus(x.toFixed(digits)).replace(/^−(0\.?0*)$/, "$1");
  /// Two significant digits, as a power of ten where there would be many zeros.
  const short = (x, digits = 2) => {
    if (x === 0) {
      return "0";
    }
    const [mantissa, power] = x.toExponential(digits - 1).split("e");
    const n = Number(power);
    return n < -4 || n > 5
      ? minus(mantissa) + " × 10" + raised(n)
      : fixed(Number(x.toPrecision(digits)), Math.max(0, digits - 1 - n));
  };

  // Controls.

  let controls = 0;
  const control = (label, input, ...more) => {
    input.id = "live-control-" + ++controls;
    return element("div", { class: "live-control" },
      element("label", { for: input.id }, label), ...more, input);
  };

  /// A slider. `text` says its value; `change` is told of a new one.
  const slider = ({ label, min, max, step, value, text, change }) => {
    const input = element("input", { type: "range", min, max, step });
    const shown = element("output", {});
    const show = () => {
      shown.textContent = text(Number(input.value));
      input.setAttribute("aria-valuetext", shown.textContent);
    };
    const set = (x) => {
      input.value = x;
      show();
    };
    input.addEventListener("input", () => {
      show();
      change(Number(input.value));
    });
    set(value);
    return { node: control(label, input, shown), set, input };
  };

  /// One of several, by their names; `change` is told its number.
  const choice = ({ label, names, value, change }) => {
    const input = element("select", {});
    const set = (given, chosen) => {
      input.replaceChildren(...given.map((name, i) => element("option", { value: i }, name)));
      input.value = chosen;
    };
    input.addEventListener("change", () => change(Number(input.value)));
    set(names, value);
    return { node: control(label, input), set, input };
  };

  /// A figure with its caption, which may be changed.
  const figure = (content, caption) => {
    const below = element("figcaption", {});
    below.innerHTML = caption;
    return element("figure", { class: "live-figure" }, ...content, below);
  };

  /// Names of colours: [["blue", "true"], …]
  const legend = (entries) => {
    const items = entries.map(([colour, name, dashes]) => {
      const line = shape("line", { x1: 0, y1: 5, x2: 22, y2: 5, "stroke-width": 2.5, stroke: hue(colour), "stroke-dasharray": dashes });
      return element("span", {}, shape("svg", { width: 22, height: 10, "aria-hidden": "true" }, line), " " + name);
    });
    return element("div", { class: "live-legend" }, ...items);
  };

  /// A table whose numbers are filled in by `set([[…], …])`.
  const table = (heads, rows) => {
    const cells = rows.map(() => heads.slice(1).map(() => element("td", {})));
    const body = rows.map((row, i) => element("tr", {}, element("th", { scope: "row" }, ...[].concat(row)), ...cells[i]));
    const node = element("div", { class: "live-table" },
      element("table", {},
        element("thead", {}, element("tr", {}, ...heads.map((h) => element("th", { scope: "col" }, h)))),
        element("tbody", {}, ...body)));
    return {
      node,
      set: (texts) => texts.forEach((row, i) => row.forEach((text, j) => (cells[i][j].textContent = text))),
    };
  };

  const hue = (name) => `var(--live-${name})`;

  /// Once in a frame, however often it is asked for.
  const once_per_frame = (f) => {
    let waits = false;
    return () => {
      if (!waits) {
        waits = true;
        requestAnimationFrame(() => {
          waits = false;
          f();
        });
      }
    };
  };

  /// Calls f with the width of an element, now and whenever that changes.
  const when_sized = (node, f) => {
    let width = 0;
    new ResizeObserver(() => {
      const now = Math.round(node.clientWidth);
      if (now && now !== width) {
        f((width = now));
      }
    }).observe(node);
  };

  // Plots.

  const nice_step = (span, count) => {
    const rough = span / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    return [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough * (1 - 1e-9));
  };
  const linear_ticks = (low, high, count) => {
    let step = nice_step(high - low, count);
    if (Math.floor(high / step) - Math.ceil(low / step) < 2) {
      step = nice_step(high - low, 2 * count);
    }
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const ticks = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
      ticks.push([i * step, fixed(i * step, digits)]);
    }
    return ticks;
  };
  const decade_ticks = (low, high, count) => {
    const every = Math.max(1, Math.ceil((high - low) / count));
    const ticks = [];
    for (let n = Math.ceil(low / every) * every; n <= high; n += every) {
      ticks.push([n, n >= 0 && n <= 2 ? minus(String(10 ** n)) : "10" + raised(n)]);
    }
    return ticks;
  };

  /// Lines over x. `draw({x: [low, high], y: [low, high], lines: [{points: [[x, y], …], colour, dashes}],
  /// at})`: of a logarithmic y its decades; `at` is marked, and chosen by a pointer where there is `choose`.
  const plot = ({ label, height, log, x_label, choose }) => {
    const svg = shape("svg", { class: "live-plot" + (choose ? " live-chosen" : ""), role: "img", "aria-label": label, height });
    const title = element("div", { class: "live-title" });
    title.innerHTML = label;
    svg.setAttribute("aria-label", title.textContent);
    const node = element("div", {}, title, svg);
    let width = 0;
    let data;
    let to_x;
    const edge = { left: 44, right: 10, top: 6, bottom: x_label ? 36 : 20 };
    const render = () => {
      if (!width || !data) {
        return;
      }
      const [x0, x1] = data.x;
      const [y0, y1] = data.y;
      const inner = [width - edge.left - edge.right, height - edge.top - edge.bottom];
      const x_of = (x) => edge.left + ((x - x0) / (x1 - x0)) * inner[0];
      const y_of = (y) => edge.top + ((y1 - (log ? Math.log10(y) : y)) / (y1 - y0)) * inner[1];
      to_x = (px) => Math.min(x1, Math.max(x0, x0 + ((px - edge.left) / inner[0]) * (x1 - x0)));
      const parts = [];
      for (const [x, text] of linear_ticks(x0, x1, width / 90)) {
        const px = x_of(x);
        parts.push(shape("line", { class: "live-grid", x1: px, x2: px, y1: edge.top, y2: height - edge.bottom }),
          shape("text", { x: px, y: height - edge.bottom + 15, "text-anchor": "middle" }, text));
      }
      const y_ticks = (log ? decade_ticks : linear_ticks)(y0, y1, Math.max(log ? 2 : 4, inner[1] / 34));
      for (const [y, text] of y_ticks) {
        const py = edge.top + ((y1 - y) / (y1 - y0)) * inner[1];
        parts.push(shape("line", { class: "live-grid", x1: edge.left, x2: width - edge.right, y1: py, y2: py }),
          shape("text", { x: edge.left - 6, y: py + 4, "text-anchor": "end" }, text));
      }
      if (x_label) {
        parts.push(shape("text", { x: edge.left + inner[0] / 2, y: height - 4, "text-anchor": "middle" }, x_label));
      }
      for (const line of data.lines) {
        const text = line.points.map(([x, y]) => {
          // Far outside is as good as further outside, and browsers draw it.
          const py = Math.min(3 * height, Math.max(-2 * height, y_of(y)));
          return x_of(x).toFixed(2) + "," + py.toFixed(2);
        });
        parts.push(shape("polyline", { class: "live-line", points: text.join(" "), stroke: hue(line.colour), "stroke-dasharray": line.dashes, "clip-path": `url(#${clip_id})` }));
      }
      if (data.at !== undefined) {
        const px = x_of(data.at);
        parts.push(shape("line", { class: "live-marker", x1: px, x2: px, y1: edge.top, y2: height - edge.bottom }));
      }
      const clip = shape("clipPath", { id: clip_id }, shape("rect", { x: edge.left, y: edge.top, width: inner[0], height: inner[1] }));
      svg.replaceChildren(clip, ...parts);
    };
    const clip_id = "live-clip-" + ++controls;
    when_sized(node, (w) => {
      svg.setAttribute("width", (width = w));
      render();
    });
    if (choose) {
      const pick = (event) => {
        if (to_x && event.buttons) {
          choose(to_x(event.clientX - svg.getBoundingClientRect().left));
        }
      };
      svg.addEventListener("pointerdown", (event) => {
        svg.setPointerCapture(event.pointerId);
        pick(event);
      });
      svg.addEventListener("pointermove", pick);
    }
    return {
      node,
      draw: (given) => {
        data = given;
        render();
      },
    };
  };

  // Space, seen from far away.

  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const sum = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);

  /// A view of what lies within `radius` of `centre`, to the left and right within `half_width`; at most
  /// `height` pixels high. What is drawn is ordered by depth. Dragging what is
  /// no handle turns the view, and arrow keys do.
  const space = ({ label, height: most, centre, radius, half_width = radius, azimuth, elevation, drawn }) => {
    const shapes = shape("g", {});
    const handles = shape("g", {});
    const svg = shape("svg", { class: "live-space", tabindex: 0, role: "group", "aria-label": label + ". Arrow keys turn the view." }, shapes, handles);
    const node = element("div", {}, svg);
    let width = 0;
    let height = 0;
    let axes;
    let scale = 1;
    let list = [];
    const look = () => {
      const [sa, ca, se, ce] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation)];
      axes = { right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], towards: [ce * ca, ce * sa, se] };
    };
    look();
    const seen = (p) => {
      const d = sum(p, centre, -1);
      return [width / 2 + scale * dot(d, axes.right), height / 2 - scale * dot(d, axes.up), dot(d, axes.towards)];
    };
    const add = (depth, node) => list.push([depth, node]);
    const redraw = () => {
      if (width) {
        list = [];
        drawn();
        list.sort((a, b) => a[0] - b[0]);
        shapes.replaceChildren(...list.map((each) => each[1]));
      }
    };
    const turn = (dx, dy) => {
      azimuth -= dx;
      elevation = Math.min(1.55, Math.max(-1.55, elevation + dy));
      look();
      redraw();
    };
    svg.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1] }[event.key];
      if (by && event.target === svg) {
        event.preventDefault();
        turn(...by);
      }
    });
    let last;
    svg.addEventListener("pointerdown", (event) => {
      if (!event.target.closest(".live-handle")) {
        svg.setPointerCapture(event.pointerId);
        last = [event.clientX, event.clientY];
      }
    });
    svg.addEventListener("pointermove", (event) => {
      if (last && event.buttons) {
        turn((event.clientX - last[0]) / 150, (event.clientY - last[1]) / 150);
        last = [event.clientX, event.clientY];
      }
    });
    for (const end of ["pointerup", "pointercancel"]) {
      svg.addEventListener(end, () => (last = undefined));
    }
    when_sized(node, (w) => {
      svg.setAttribute("width", (width = w));
      svg.setAttribute("height", (height = Math.min(most, Math.round((w * radius) / half_width))));
      scale = Math.min(width / half_width, height / radius) / 2;
      redraw();
    });

    const path = (points, closed) =>
      points.map((p, i) => (i ? "L" : "M") + seen(p).slice(0, 2).map((x) => x.toFixed(2)).join(" ")).join("") + (closed ? "Z" : "");
    const depth_of = (points) => points.reduce((s, p) => s + seen(p)[2], 0) / points.length;
    return {
      node,
      redraw,
      seen,
      look_at: (given) => (centre = given),
      axes: () => axes,
      scale: () => scale,
      /// `style` as attributes of SVG; `shift` moves it towards who looks in the order of drawing.
      line: (points, style, shift = 0) =>
        add(depth_of(points) + shift, shape("path", { d: path(points), fill: "none", "stroke-linecap": "round", "stroke-linejoin": "round", ...style })),
      face: (points, style, shift = 0) => add(depth_of(points) + shift, shape("path", { d: path(points, true), "stroke-linejoin": "round", ...style })),
      ball: (p, pixels, style, shift = 0) => {
        const [x, y, depth] = seen(p);
        add(depth + shift, shape("circle", { cx: x, cy: y, r: pixels, ...style }));
      },
      text: (p, text, style, shift = 0) => {
        const [x, y, depth] = seen(p);
        add(depth + shift, shape("text", { x, y, "text-anchor": "middle", ...style }, text));
      },
      arrow: (from, to, colour, style, shift = 0) => {
        const a = seen(from);
        const b = seen(to);
        const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
        const head = Math.min(9, length);
        const [ux, uy] = length ? [(b[0] - a[0]) / length, (b[1] - a[1]) / length] : [0, 0];
        const at = (back, side) => `${(b[0] - back * ux - side * uy).toFixed(2)} ${(b[1] - back * uy + side * ux).toFixed(2)}`;
        add((a[2] + b[2]) / 2 + shift,
          shape("g", { stroke: hue(colour), fill: hue(colour), ...style },
            shape("path", { d: `M${a[0].toFixed(2)} ${a[1].toFixed(2)}L${at(head * 0.8, 0)}`, "stroke-width": 2.5, "stroke-linecap": "round" }),
            shape("path", { d: `M${at(0, 0)}L${at(head, head * 0.42)}L${at(head, -head * 0.42)}Z`, stroke: "none" })));
      },
      /// Something to be dragged, or moved by keys: `drag([x, y])` gets places in pixels of the view,
      /// `keys` functions by name of key. `place(p, text)` puts it to a place in space and says where that is.
      handle: ({ label, text = "", colour, drag, keys, focus }) => {
        const knob = shape("circle", { r: text ? 9 : 8, fill: hue(colour), class: "live-knob" });
        const g = shape("g", { class: "live-handle", tabindex: 0, role: "slider", "aria-label": label, "aria-valuenow": 0 },
          shape("circle", { r: 20, fill: "transparent" }), knob,
          shape("text", { y: 4, "text-anchor": "middle" }, text));
        g.addEventListener("pointerdown", (event) => {
          event.preventDefault();
          g.focus({ preventScroll: true });
          g.setPointerCapture(event.pointerId);
        });
        // Browsers differ in whether touch-action is minded within an SVG.
        g.addEventListener("touchstart", (event) => event.preventDefault(), { passive: false });
        g.addEventListener("pointermove", (event) => {
          if (g.hasPointerCapture(event.pointerId)) {
            const box = svg.getBoundingClientRect();
            const within = (x, most) => Math.min(most, Math.max(0, x));
            drag([within(event.clientX - box.left, width), within(event.clientY - box.top, height)]);
          }
        });
        g.addEventListener("keydown", (event) => {
          const f = keys[event.key];
          if (f) {
            event.preventDefault();
            f();
          }
        });
        if (focus) {
          g.addEventListener("focus", focus);
        }
        handles.append(g);
        return {
          node: g,
          place: (p, text, value = 0) => {
            const [x, y, depth] = seen(p);
            g.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
            g.setAttribute("aria-valuetext", text);
            g.setAttribute("aria-valuenow", value);
            return depth;
          },
        };
      },
      in_front: (node) => handles.append(node),
    };
  };

  // duet.

  /// A function `call(name, inputs, size)` on a module of Emscripten's: numbers and arrays go in, `size`
  /// numbers come out as `numbers`, what the function returned as `returned`. `calls` keeps the last of each.
  const caller = (module, calls) => {
    const room = 1 << 16;
    const start = module._malloc(8 * room);
    return (name, inputs, size) => {
      const stack = module.stackSave();
      let used = 0;
      const place = (count) => {
        used += count;
        if (used > room) {
          throw new Error(`${name}: no room for ${used} numbers`);
        }
        return start + 8 * (used - count);
      };
      const given = inputs.map((x) => {
        if (typeof x === "number") {
          return x;
        }
        const at = place(x.length);
        module.HEAPF64.set(x, at / 8);
        return at;
      });
      const out = place(size);
      module.HEAPF64.fill(0, out / 8, out / 8 + size);
      try {
        const returned = module["_" + name](...given, out);
        const numbers = Array.from(module.HEAPF64.subarray(out / 8, out / 8 + size));
        calls[name] = { inputs, numbers, returned };
        return calls[name];
      } finally {
        module.stackRestore(stack);
      }
    };
  };

  /// The WebAssembly of a script, which holds it compressed (pack.py).
  const unpacked = (packed) => {
    const bytes = Uint8Array.from(atob(packed), (character) => character.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  };

  /// Starts the page in each <div class="live" data-live="<name>">: `build(host, call)` adds the controls. If
  /// the module cannot run, the static content stays, with a sentence that says why. `call` is what `begin`
  /// promises: a caller of the module, unless the page makes something else of it.
  const start = (name, build, begin = (factory, wasmBinary, page) => factory({ wasmBinary }).then((module) => caller(module, page.calls))) => {
    for (const place of document.querySelectorAll(`.live[data-live="${name}"]`)) {
      const stay = (why) => {
        place.prepend(element("p", { class: "live-missing" }, why + " This is an example of what it computes."));
      };
      if (typeof WebAssembly !== "object" || typeof DecompressionStream !== "function") {
        stay("This page computes in the browser by WebAssembly, which is missing or switched off here.");
        continue;
      }
      const factory = window["duet_" + name];
      if (!factory) {
        stay("What this page computes with was not loaded.");
        continue;
      }
      const page = { calls: {} };
      unpacked(factory.packed).then((wasmBinary) => begin(factory, wasmBinary, page)).then((call) => {
        const host = element("div", { class: "live-host" });
        pages[name] = page;
        place.append(host);
        build(host, call);
        place.classList.add("live-runs");
        requestAnimationFrame(() => (page.first_figure = performance.now()));
      }).catch((error) => {
        place.classList.remove("live-runs");
        place.querySelectorAll(".live-host").forEach((host) => host.remove());
        stay("This page does not compute here: " + error.message + ".");
        console.error(error);
      });
    }
  };

  return { pages, start, element, shape, fixed, short, slider, choice, figure, legend, table, hue, once_per_frame, plot, space, cross, dot, sum };
})();
