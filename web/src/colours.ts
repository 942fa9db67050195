// Cividis: from blue over grey to yellow, of rising lightness, told apart by people of every colour vision (Nunez, Anderton
// and Renslow, PLOS ONE 2018). Red links are also counted in the text, and are under the margin's line in the plot.

const CIVIDIS = ["#00204d", "#31446b", "#666870", "#958f78", "#cbba69", "#ffea46"];

/** The colour of links within the margin. */
export const RED = "#d80000";

/** As a background of the legend. */
export const GRADIENT = `linear-gradient(to right, ${CIVIDIS.join(", ")})`;

/** Red, green and blue from 0 to 1 at a share of the way from near to far. */
function colour(share: number): [number, number, number] {
  const at = Math.min(Math.max(share, 0), 1) * (CIVIDIS.length - 1);
  const k = Math.min(Math.floor(at), CIVIDIS.length - 2);
  const [from, to] = [channels(CIVIDIS[k]), channels(CIVIDIS[k + 1])];
  return [0, 1, 2].map((c) => from[c]! + (at - k) * (to[c]! - from[c]!)) as [number, number, number];
}

/** The colour of a link, as red, green and blue from 0 to 1. */
export function linkColour(distance: number, margin: number, farthest: number): [number, number, number] {
  return distance <= margin ? channels(RED) : colour(distance / farthest);
}

/** Red, green and blue from 0 to 1. */
function channels(hex = "#000000"): [number, number, number] {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255) as [number, number, number];
}
