import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import type { Answers, Wall } from "./engine/continuum_web.js";
import { RED, linkColour } from "./colours";

const AROUND = 24;
/** What is drawn after the wall, in this order: links, lines of links within the margin, the closest pair and its halo. */
const [LINKS, NEAR, HALO, PAIR] = [1, 2, 3, 4];
/** The width of the dark line around the robot, as a share of the link's radius. */
const OUTLINE = 0.12;
/** The size of the dots at the closest points, as a share of the picture's height. */
const DOT = 0.009;
/** How many gaps the picture of the closest pair is away, and at least which share of the wall's radius. */
const [GAPS, NEAREST] = [12, 0.15];

/** The picture: wall, links, and lines between closest points. */
export class Scene {
  private readonly renderer: three.WebGLRenderer;
  private readonly scene = new three.Scene();
  private readonly camera = new three.PerspectiveCamera(35, 1, 0.1, 10_000);
  private readonly controls: OrbitControls;
  private readonly robot = new three.Group();
  /** The closest points of robot and wall. */
  private pair?: [three.Vector3, three.Vector3];
  private wall?: three.Mesh;
  /** The radius around the wall's centre that has been in view. */
  private inView = 0;

  constructor(private readonly canvas: HTMLCanvasElement) {
    this.renderer = new three.WebGLRenderer({ canvas, antialias: true });
    this.scene.background = new three.Color("#f7f7f5");
    this.scene.add(new three.HemisphereLight("#ffffff", "#888888", 2.5), this.robot);
    const lamp = new three.DirectionalLight("#ffffff", 1.5);
    this.camera.add(lamp);
    this.scene.add(this.camera);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    canvas.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  showWall(wall: Wall) {
    this.hideWall();
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(wall.vertices(), 3));
    geometry.setIndex(new three.Uint32BufferAttribute(wall.triangles(), 1));
    geometry.computeVertexNormals();
    const material = new three.MeshLambertMaterial({
      color: "#c9a79c",
      transparent: true,
      opacity: 0.25,
      side: three.DoubleSide,
      depthWrite: false,
    });
    this.wall = new three.Mesh(geometry, material);
    this.scene.add(this.wall);
    geometry.computeBoundingSphere();
    this.lookAt(geometry.boundingSphere!, new three.Vector3(1, -1.6, 0.9));
  }

  /** Shows all of a sphere from a direction. */
  private lookAt({ center, radius }: three.Sphere, from: three.Vector3) {
    this.inView = radius;
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(from.setLength(radius * 3));
    this.camera.near = radius / 100;
    this.camera.far = radius * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  /** Moves back if the robot has left the wall so far that it is out of view. */
  private keepInView(points: three.Vector3[]) {
    if (!this.wall) return;
    const { center } = this.wall.geometry.boundingSphere!;
    const radius = Math.max(...points.map((point) => point.distanceTo(center)));
    if (radius <= this.inView) return;
    this.lookAt(new three.Sphere(center, radius), this.camera.position.clone().sub(this.controls.target));
  }

  hideWall() {
    if (!this.wall) return;
    this.scene.remove(this.wall);
    this.wall.geometry.dispose();
    (this.wall.material as three.Material).dispose();
    this.wall = undefined;
    this.draw();
  }

  showRobot(answers: Answers, margin: number, farthest: number) {
    this.clearRobot();
    const [ends, radii, round] = [answers.ends(), answers.radii(), answers.is_round()];
    const [distances, onRobot, onMesh] = [answers.distances(), answers.on_robot(), answers.on_mesh()];
    const point = (from: Float64Array, k: number) => new three.Vector3(...from.slice(3 * k, 3 * k + 3));
    distances.forEach((distance, link) => {
      const shade = new three.Color().setRGB(...linkColour(distance, margin, farthest), three.SRGBColorSpace);
      const [start, end] = [point(ends, 2 * link), point(ends, 2 * link + 1)];
      const caps: [boolean, boolean] = [round[2 * link]! > 0, round[2 * link + 1]! > 0];
      const place = (radius: number, material: three.Material) => {
        const mesh = new three.Mesh(outline(start.distanceTo(end), radius, caps), material);
        mesh.position.copy(start);
        mesh.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), end.clone().sub(start).normalize());
        mesh.renderOrder = LINKS;
        this.robot.add(mesh);
      };
      // Transparent materials are drawn in the order of `renderOrder`: the wall does not veil the links.
      place(radii[link]!, new three.MeshLambertMaterial({ color: shade, transparent: true }));
      const dark = { color: "#1b1b1b", side: three.BackSide, transparent: true };
      place(radii[link]! * (1 + OUTLINE), new three.MeshBasicMaterial(dark));
      if (distance <= margin) this.line(point(onRobot, link), point(onMesh, link), RED, 2, NEAR);
    });
    this.keepInView(Array.from({ length: 2 * distances.length }, (_, k) => point(ends, k)));
    const [from, to] = [point(onRobot, answers.closest()), point(onMesh, answers.closest())];
    this.pair = [from, to];
    this.line(from, to, "#ffffff", 7, HALO);
    this.line(from, to, "#000000", 3, PAIR);
    for (const end of [from, to]) {
      this.dot(end, "#ffffff", 1.5 * DOT, HALO);
      this.dot(end, "#000000", DOT, PAIR);
    }
    this.draw();
  }

  hideRobot() {
    this.clearRobot();
    this.draw();
  }

  private clearRobot() {
    for (const child of this.robot.children as three.Mesh[]) {
      // All sprites share one geometry.
      if (!(child instanceof three.Sprite)) child.geometry.dispose();
      (child.material as three.Material).dispose();
    }
    this.robot.clear();
    this.pair = undefined;
  }

  /** Moves near to the closest pair, and looks across it. */
  showPair() {
    if (!this.pair || !this.wall) return;
    const [from, to] = this.pair;
    const gap = to.clone().sub(from);
    const { radius } = this.wall.geometry.boundingSphere!;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const across = offset.clone().projectOnPlane(gap.clone().normalize());
    const away = Math.max(GAPS * gap.length(), radius * NEAREST);
    this.controls.target.copy(from).add(to).multiplyScalar(0.5);
    this.camera.position.copy(across.lengthSq() > 0 ? across : offset).setLength(away).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  /** A line of a width in pixels, in front of everything. */
  private line(from: three.Vector3, to: three.Vector3, color: string, linewidth: number, order: number) {
    const geometry = new LineSegmentsGeometry().setPositions([...from.toArray(), ...to.toArray()]);
    const material = new LineMaterial({ color, linewidth, depthTest: false, transparent: true });
    const line = new LineSegments2(geometry, material);
    line.renderOrder = order;
    this.robot.add(line);
  }

  /** A dot of a size that does not depend on its distance, in front of everything. */
  private dot(at: three.Vector3, color: string, size: number, order: number) {
    const material = new three.SpriteMaterial({ color, map: DISC, sizeAttenuation: false, depthTest: false });
    const sprite = new three.Sprite(material);
    sprite.position.copy(at);
    sprite.scale.setScalar(size);
    sprite.renderOrder = order;
    this.robot.add(sprite);
  }

  private key(event: KeyboardEvent) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const side = new three.Vector3().crossVectors(this.camera.up, offset).normalize();
    const turn = (axis: three.Vector3, angle: number) => offset.applyAxisAngle(axis, angle);
    if (event.key === "ArrowLeft") turn(this.camera.up, -0.1);
    else if (event.key === "ArrowRight") turn(this.camera.up, 0.1);
    else if (event.key === "ArrowUp") turn(side, -0.1);
    else if (event.key === "ArrowDown") turn(side, 0.1);
    else if (event.key === "+" || event.key === "=") offset.multiplyScalar(0.9);
    else if (event.key === "-") offset.multiplyScalar(1 / 0.9);
    else return;
    event.preventDefault();
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  private resize() {
    const { clientWidth, clientHeight } = this.canvas;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(clientHeight, 1);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private draw() {
    this.renderer.render(this.scene, this.camera);
  }
}

/** A white disc. */
const DISC = (() => {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const pen = canvas.getContext("2d")!;
  pen.fillStyle = "#ffffff";
  pen.arc(32, 32, 31, 0, 2 * Math.PI);
  pen.fill();
  return new three.CanvasTexture(canvas);
})();

/** A tube along y from the origin, with a flat or round cap at each end. */
function outline(length: number, radius: number, round: [boolean, boolean]): three.BufferGeometry {
  const STEPS = 8;
  const cap = (isRound: boolean, at: number, outward: number) => {
    if (!isRound) return [new three.Vector2(0, at), new three.Vector2(radius, at)];
    return Array.from({ length: STEPS + 1 }, (_, k) => {
      const angle = (Math.PI / 2) * (k / STEPS);
      return new three.Vector2(radius * Math.sin(angle), at + outward * radius * Math.cos(angle));
    });
  };
  const profile = [...cap(round[0], 0, -1), ...cap(round[1], length, 1).reverse()];
  return new three.LatheGeometry(profile, AROUND);
}
