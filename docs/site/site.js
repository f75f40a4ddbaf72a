// Copyright (c) 2026 the duet authors. MIT licence, see LICENSE.

// Light or dark, the menu, pictures to be enlarged, and the search. Pages are complete without it.

"use strict";
{
  const top_of_site = document.currentScript.dataset.top;

  // Browsers may keep nothing for pages from disk.
  const kept = {
    read() { try { return localStorage.getItem("theme"); } catch { return null; } },
    write(theme) { try { localStorage.setItem("theme", theme); } catch { /* then it is not kept */ } },
  };
  const root = document.documentElement;
  const is_dark = () => (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
  if (kept.read()) {
    root.dataset.theme = kept.read();
  }

  // The index is read when it is first asked for: as a script, since pages from disk may read nothing else.
  let index;
  const load_index = () => index ??= new Promise((done) => {
    const script = document.createElement("script");
    script.src = top_of_site + "search_index.js";
    script.onload = () => done(search_index.map(([title, page, address, text]) =>
      ({ title, page, address, text, low_title: title.toLowerCase(), low_text: text.toLowerCase() })));
    document.head.append(script);
  });

  // All words must occur; names that are or begin with a word come first, then titles, then texts.
  const rank = (entry, words) => {
    let sum = 0;
    for (const word of words) {
      const at = entry.low_title.indexOf(word);
      const part = entry.low_title === word ? 100 : at === 0 ? 40 : at > 0 ? 20 : entry.low_text.includes(word) ? 1 : 0;
      if (part === 0) {
        return 0;
      }
      sum += part;
    }
    return sum + (entry.address.startsWith("reference/") ? 0 : 5);
  };

  const excerpt = (entry, word) => {
    const at = Math.max(entry.low_text.indexOf(word), 0);
    const from = at < 60 ? 0 : entry.text.indexOf(" ", at - 50) + 1;
    return (from > 0 ? "… " : "") + entry.text.slice(from, from + 140);
  };

  const search = async (text, list) => {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    const entries = await load_index();
    const found = words.length === 0 ? [] : entries.map((entry) => ({ entry, score: rank(entry, words) }))
      .filter(({ score }) => score > 0).sort((a, b) => b.score - a.score).slice(0, 20);
    list.replaceChildren(...found.map(({ entry }) => {
      const link = document.createElement("a");
      link.href = top_of_site + entry.address;
      for (const [tag, said] of [["b", entry.title], ["i", entry.page === entry.title ? "" : entry.page],
                                 ["span", excerpt(entry, words[0])]]) {
        const part = document.createElement(tag);
        part.textContent = said;
        link.append(part);
      }
      const item = document.createElement("li");
      item.append(link);
      return item;
    }));
    if (words.length > 0 && found.length === 0) {
      const item = document.createElement("li");
      item.textContent = "Nothing found";
      list.append(item);
    }
    list.hidden = words.length === 0;
  };

  addEventListener("DOMContentLoaded", () => {
    document.getElementById("theme").addEventListener("click", () => {
      root.dataset.theme = is_dark() ? "light" : "dark";
      kept.write(root.dataset.theme);
    });

    for (const picture of document.querySelectorAll(".picture")) {
      const turn = () => picture.classList.toggle("large");
      picture.addEventListener("click", turn);
      picture.addEventListener("keydown", (event) => event.key === "Enter" && turn());
    }

    const wide = matchMedia("(min-width: 62rem)");
    const menu = document.querySelector(".menu");
    const contents = document.querySelector(".contents");
    const unfold = () => {
      menu.open = wide.matches;
      if (contents) {
        contents.open = wide.matches;
      }
    };
    wide.addEventListener("change", unfold);
    unfold();
    const here = menu.querySelector("[aria-current]");
    const bar = menu.querySelector("nav");
    if (here && here.offsetTop > bar.clientHeight - 60) {
      bar.scrollTop = here.offsetTop - bar.clientHeight / 2;
    }

    const query = document.getElementById("query");
    const list = document.getElementById("found");
    query.addEventListener("focus", load_index);
    query.addEventListener("input", () => search(query.value, list));
    query.addEventListener("keydown", (event) => {
      if (event.key === "Enter") {
        list.querySelector("a")?.click();
      }
    });
    addEventListener("keydown", (event) => {
      if (event.key === "/" && document.activeElement.tagName !== "INPUT") {
        event.preventDefault();
        query.focus();
      } else if (event.key === "Escape") {
        list.hidden = true;
        query.blur();
      }
    });
    addEventListener("click", (event) => {
      if (!event.target.closest(".search")) {
        list.hidden = true;
      }
    });

    if (matchMedia("(prefers-reduced-motion: reduce)").matches) {
      for (const picture of document.querySelectorAll("svg")) {
        picture.pauseAnimations();
        picture.setCurrentTime(5);
      }
    }
  });
}
