import * as Plot from "@observablehq/plot";
import type { Answers } from "./engine/continuum_web.js";
import { RED, linkColour } from "./colours";

/** The clearance along the robot: a bar for each link, the margin as a line, and the closest place as a dot. */
export function plotClearance(into: HTMLElement, answers: Answers, margin: number, farthest: number) {
  let along = 0;
  const [lengths, distances] = [answers.lengths(), answers.distances()];
  const links = Array.from(distances, (distance, link) => {
    const from = along;
    along += lengths[link]!;
    const [red, green, blue] = linkColour(distance, margin, farthest).map((share) => Math.round(255 * share));
    const title = `Link ${link}: ${distance.toFixed(3)} mm`;
    return { from, to: along, distance, fill: `rgb(${red}, ${green}, ${blue})`, title };
  });
  const figure = Plot.plot({
    width: into.clientWidth,
    height: into.clientHeight,
    marginTop: 22,
    marginBottom: 34,
    ariaLabel: "The clearance of each link along the robot",
    x: { label: "along the robot from its base (mm)", domain: [0, along] },
    y: { label: "clearance (mm)", grid: true, domain: [0, Math.max(margin, ...distances) * 1.05 || 1], ticks: 4 },
    marks: [
      Plot.rect(links, {
        x1: "from", x2: "to", y1: 0, y2: "distance", fill: "fill", stroke: "#1b1b1b", strokeWidth: 0.5, title: "title",
        className: "links",
      }),
      Plot.ruleY([margin], { stroke: RED, strokeWidth: 2, strokeDasharray: "6 3", className: "margin" }),
      Plot.ruleY([0]),
      Plot.dot([[answers.arc_length(), answers.minimum()]], {
        fill: "#ffffff", stroke: "#000000", strokeWidth: 2, r: 4, className: "closest",
      }),
    ],
  });
  into.replaceChildren(figure);
}
