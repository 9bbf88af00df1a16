/** What the peers' pages share of three.js. */
import * as THREE from 'three';
import { makeCanvas, turned } from './page.js';

/** A canvas of three's and a float target of the same size. */
export class ThreeCanvas {
  constructor(size) {
    this.size = size;
    this.renderer = new THREE.WebGLRenderer({ canvas: makeCanvas(size), antialias: false });
    this.target = new THREE.WebGLRenderTarget(size, size, { type: THREE.FloatType });
  }
  /** The target: 4 floats a pixel, row 0 at the top. */
  read() {
    const { size } = this;
    const pixels = new Float32Array(4 * size * size);
    this.renderer.readRenderTargetPixels(this.target, 0, 0, size, size, pixels);
    return turned(pixels, 4 * size);
  }
  /** Gives everything back, the context too: browsers keep few of them. */
  dispose() {
    this.target.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }
}
