// The input fields of the page.

export const find = <Element extends HTMLElement>(id: string) => document.getElementById(id) as Element;

/** The number in a field, or undefined if the field is empty. Throws the text of an error. */
export function optionalNumber(id: string, name: string, isAllowed: (value: number) => boolean, rule: string) {
  const input = find<HTMLInputElement>(id);
  if (input.validity.badInput) throw `${name} is not a number; enter ${rule}`;
  if (input.value.trim() === "") return undefined;
  const value = Number(input.value);
  if (!Number.isFinite(value) || !isAllowed(value)) throw `${name} is ${input.value}; enter ${rule}`;
  return value;
}

/** The number in a field. Throws the text of an error. */
export function number(id: string, name: string, isAllowed: (value: number) => boolean, rule: string) {
  const value = optionalNumber(id, name, isAllowed, rule);
  if (value === undefined) throw `${name} is empty; enter ${rule}`;
  return value;
}

export const notNegative = (value: number) => value >= 0;
export const positive = (value: number) => value > 0;

/** Replaces the options of a choice; each is a value and its text. */
export function fill(id: string, options: [string, string][]) {
  const select = find<HTMLSelectElement>(id);
  select.replaceChildren(...options.map(([value, text]) => new Option(text, value)));
}

/** The value of a choice, or undefined if it is the empty one. */
export function chosen(id: string): string | undefined {
  return find<HTMLSelectElement>(id).value || undefined;
}

/** Puts the choices of scale and frame, which robot and wall share, at their place in the page. */
export function addCoordinates(role: "robot" | "wall") {
  find(`${role}-coordinates`).outerHTML = `
    <div class="choice">
      <label for="${role}-scale">Scale, for example 1000 for metres</label>
      <input id="${role}-scale" type="number" min="0" step="any" />
    </div>
    <div class="choice">
      <label for="${role}-frame">Frame, if the file states none</label>
      <select id="${role}-frame"></select>
    </div>`;
}

/** Resets the choices of scale and frame. */
export function resetCoordinates(role: "robot" | "wall") {
  find<HTMLInputElement>(`${role}-scale`).value = "1";
  fill(`${role}-frame`, [["", "not stated"], ["RAS", "RAS"], ["LPS", "LPS"]]);
  find<HTMLSelectElement>(`${role}-frame`).disabled = false;
}

/** Shows the frame that a file states. It is not the user's to choose. */
export function showStatedFrame(id: string, frame: string | undefined) {
  if (frame === undefined) return;
  fill(id, [[frame, `${frame}, stated by the file`]]);
  find<HTMLSelectElement>(id).disabled = true;
}
