// Error against time, on a logarithmic scale. A click goes to the frame of the nearest point.

import { percent } from "./job_view.js";

/** Points in the order of time as columns: times, errors of preliminary pictures, errors of final ones. */
export function columns(points) {
  const sorted = [...points].sort((p, q) => p.time_s - q.time_s);
  return {
    sorted,
    data: [
      sorted.map((p) => p.time_s),
      sorted.map((p) => (p.final ? null : p.error)),
      sorted.map((p) => (p.final ? p.error : null)),
    ],
  };
}

/** The library is fetched where the service has it; without it the newest points stand in a table. */
async function load_library() {
  try {
    return (await import("/viewer/uPlot.esm.js")).default;
  } catch {
    return null;
  }
}

function show_table(element, points) {
  const table = document.createElement("table");
  table.insertRow().innerHTML = "<th>s</th><th>frame</th><th>error</th>";
  for (const point of points.slice(-8)) {
    const row = table.insertRow();
    for (const text of [point.time_s.toFixed(1), point.frame, percent(point.error)]) row.insertCell().textContent = text;
  }
  element.replaceChildren(table);
}

export async function make_chart(element, on_choose) {
  const library = await load_library();
  if (!library) return { show: (points) => show_table(element, points) };

  let shown = [];
  const dots = (label, colour) => ({
    label, stroke: colour, paths: () => null, points: { show: true, size: 6, fill: colour },
    value: (_, v) => (v == null ? "–" : percent(v)),
  });
  const axis = { stroke: "#a3a3a3", grid: { stroke: "#333" }, ticks: { stroke: "#333" } };
  const chart = new library({
    width: element.clientWidth, height: 220,
    scales: { x: { time: false }, y: { distr: 3 } },
    axes: [{ ...axis, label: "seconds" }, { ...axis, values: (_, ticks) => ticks.map((t) => (t == null ? "" : percent(t))), size: 64 }],
    series: [{ label: "s", value: (_, v) => (v == null ? "–" : v.toFixed(1)) }, dots("preliminary: residual", "#b87333"), dots("final: certificate", "#5fae6e")],
  }, [[], [], []], element);
  chart.over.addEventListener("click", () => {
    const point = shown[chart.cursor.idx];
    if (point) on_choose(point.frame);
  });
  new ResizeObserver(() => chart.setSize({ width: element.clientWidth, height: 220 })).observe(element);
  return {
    show(points) {
      const { sorted, data } = columns(points);
      shown = sorted;
      chart.setData(data);
    },
  };
}
