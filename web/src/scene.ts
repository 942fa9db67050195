import * as three from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Answers, Wall } from "./engine/continuum_web.js";
import { RED, channels, colour } from "./colours";

const AROUND = 24;

/** The picture: wall, links, and lines between closest points. */
export class Scene {
  private readonly renderer: three.WebGLRenderer;
  private readonly scene = new three.Scene();
  private readonly camera = new three.PerspectiveCamera(35, 1, 0.1, 10_000);
  private readonly controls: OrbitControls;
  private readonly robot = new three.Group();
  private wall?: three.Mesh;

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
    if (this.wall) {
      this.scene.remove(this.wall);
      this.wall.geometry.dispose();
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(wall.vertices(), 3));
    geometry.setIndex(new three.Uint32BufferAttribute(wall.triangles(), 1));
    geometry.computeVertexNormals();
    const material = new three.MeshLambertMaterial({
      color: "#b9a9a0",
      transparent: true,
      opacity: 0.3,
      side: three.DoubleSide,
      depthWrite: false,
    });
    this.wall = new three.Mesh(geometry, material);
    this.scene.add(this.wall);
    geometry.computeBoundingSphere();
    const { center, radius } = geometry.boundingSphere!;
    this.controls.target.copy(center);
    this.camera.position.copy(center).add(new three.Vector3(1, -1.6, 0.9).setLength(radius * 3));
    this.camera.near = radius / 100;
    this.camera.far = radius * 20;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }

  showRobot(answers: Answers, margin: number, farthest: number) {
    for (const child of this.robot.children as (three.Mesh | three.LineSegments)[]) {
      child.geometry.dispose();
      (child.material as three.Material).dispose();
    }
    this.robot.clear();
    const [ends, radii, round] = [answers.ends(), answers.radii(), answers.is_round()];
    const [distances, onRobot, onMesh] = [answers.distances(), answers.on_robot(), answers.on_mesh()];
    const point = (from: Float64Array, k: number) => new three.Vector3(...from.slice(3 * k, 3 * k + 3));
    distances.forEach((distance, link) => {
      const near = distance <= margin;
      const shade = near ? channels(RED) : colour(distance / farthest);
      const material = new three.MeshLambertMaterial({ color: new three.Color().setRGB(...shade, three.SRGBColorSpace) });
      const [start, end] = [point(ends, 2 * link), point(ends, 2 * link + 1)];
      const geometry = outline(start.distanceTo(end), radii[link]!, [round[2 * link]! > 0, round[2 * link + 1]! > 0]);
      const mesh = new three.Mesh(geometry, material);
      mesh.position.copy(start);
      mesh.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), end.clone().sub(start).normalize());
      this.robot.add(mesh);
      const closest = link === answers.closest();
      if (closest || near) {
        const line = new three.BufferGeometry().setFromPoints([point(onRobot, link), point(onMesh, link)]);
        const style = new three.LineBasicMaterial({ color: closest ? "#000000" : RED, depthTest: false });
        this.robot.add(new three.LineSegments(line, style));
      }
      if (closest) {
        const dot = new three.SphereGeometry(Math.max(radii[link]! * 0.35, 1e-9), 12, 8);
        const black = new three.MeshBasicMaterial({ color: "#000000", depthTest: false });
        const mark = new three.Mesh(dot, black);
        mark.position.copy(point(onMesh, link));
        this.robot.add(mark);
      }
    });
    this.draw();
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
