/** Offers a text as a file. */
export function save(name: string, text: string, type = "text/plain") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type }));
  link.download = name;
  link.click();
  // The browser may read the file later than the click.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
