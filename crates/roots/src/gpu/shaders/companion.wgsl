// The eigenvalues of the companion matrix: the twin of companion.rs, which has the derivation.

var<private> matrix: array<Coefficients, ROOM>;

fn companion(monic: ptr<function, Coefficients>, degree: u32) {
    for (var i = 0u; i < degree; i++) {
        for (var j = 0u; j < degree; j++) {
            matrix[i][j] = select(real(0.0), real(1.0), i == j + 1u);
        }
        matrix[i][degree - 1u] = -(*monic)[i];
    }
    balance(degree);
    eigenvalues(degree);
}

// Scales rows and columns by powers of two until they are about equally long.
fn balance(n: u32) {
    for (var round = 0u; round < 8u; round++) {
        var done = true;
        for (var i = 0u; i < n; i++) {
            var row = real(0.0);
            var column = real(0.0);
            for (var j = 0u; j < n; j++) {
                if (j != i) {
                    row += abs(matrix[i][j]);
                    column += abs(matrix[j][i]);
                }
            }
            if (row == real(0.0) || column == real(0.0)) {
                continue;
            }
            let shift = (exponent(row) - exponent(column)) / 2;
            if (shift == 0) {
                continue;
            }
            done = false;
            for (var j = 0u; j < n; j++) {
                matrix[j][i] = times_power_of_two(matrix[j][i], shift);
            }
            for (var j = 0u; j < n; j++) {
                matrix[i][j] = times_power_of_two(matrix[i][j], -shift);
            }
        }
        if (done) {
            break;
        }
    }
}

// Adds the eigenvalues of a Hessenberg matrix, as many as converge.
fn eigenvalues(n: u32) {
    var end = n; // rows from here on are done
    var sweeps = 0u;
    while (0u < end) {
        let last = end - 1u;
        var start = last;
        while (0u < start) {
            let below = abs(matrix[start][start - 1u]);
            if (below <= UNIT_ROUNDOFF * (abs(matrix[start - 1u][start - 1u]) + abs(matrix[start][start]))) {
                matrix[start][start - 1u] = real(0.0);
                break;
            }
            start--;
        }
        if (start == last) {
            push_root(matrix[last][last], real(0.0));
            end -= 1u;
            sweeps = 0u;
        } else if (start + 1u == last) {
            eigenvalue_block(matrix[start][start], matrix[start][last], matrix[last][start], matrix[last][last]);
            end -= 2u;
            sweeps = 0u;
        } else if (sweeps == COMPANION_SWEEPS) {
            return;
        } else {
            sweeps++;
            sweep(start, last, sweeps % 20u == 0u);
        }
    }
}

// Adds the eigenvalues of a block of two rows.
fn eigenvalue_block(a: real, b: real, c: real, d: real) {
    let p = (a - d) * real(0.5);
    let bc = b * c;
    let discriminant = p * p + bc;
    if (discriminant < real(0.0)) {
        push_pair(d + p, sqrt(-discriminant));
    } else {
        let root = sqrt(discriminant);
        let z = select(p - root, p + root, real(0.0) <= p);
        push_root(d + z, real(0.0));
        if (z == real(0.0)) {
            push_root(d, real(0.0));
        } else {
            push_root(d - bc / z, real(0.0));
        }
    }
}

// One double-shift QR sweep over the rows start..=last, at least three.
fn sweep(start: u32, last: u32, exceptional: bool) {
    // The shifts are the eigenvalues of the last block: their sum and product.
    let corner = matrix[last][last];
    var sum = matrix[last - 1u][last - 1u] + corner;
    var product = matrix[last - 1u][last - 1u] * corner - matrix[last - 1u][last] * matrix[last][last - 1u];
    if (exceptional) {
        // Any other shift breaks a cycle.
        let size = abs(matrix[last][last - 1u]) + abs(matrix[last - 1u][last - 2u]);
        sum = size * real(1.5) + corner + corner;
        product = size * size + corner * (size * real(1.5) + corner);
    }
    // The first column of (H - shift 1) (H - shift 2), up to a factor.
    let h00 = matrix[start][start];
    let h10 = matrix[start + 1u][start];
    var x = (h00 * (h00 - sum) + product) / h10 + matrix[start][start + 1u];
    var y = h00 + matrix[start + 1u][start + 1u] - sum;
    var z = matrix[start + 2u][start + 1u];
    for (var k = start; k < last; k++) {
        let three = k + 2u <= last;
        if (!three) {
            z = real(0.0);
        }
        let size = max(max(abs(x), abs(y)), abs(z));
        if (real(0.0) < size) {
            reflect_rows(start, last, k, three, x / size, y / size, z / size, size);
        }
        x = matrix[k + 1u][k];
        y = real(0.0);
        z = real(0.0);
        if (k + 2u <= last) {
            y = matrix[k + 2u][k];
        }
        if (k + 3u <= last) {
            z = matrix[k + 3u][k];
        }
    }
}

// The reflection 1 - v w^T that turns (x, y, z) into (-norm, 0, 0), with v = (1, v1, v2), from both
// sides.
fn reflect_rows(start: u32, last: u32, k: u32, three: bool, sx: real, sy: real, sz: real, size: real) {
    let radius = sqrt(sx * sx + sy * sy + sz * sz);
    let signed = select(radius, -radius, sx < real(0.0));
    let pivot = sx + signed;
    let v1 = sy / pivot;
    let v2 = sz / pivot;
    let w0 = pivot / signed;
    let w1 = w0 * v1;
    let w2 = w0 * v2;
    if (start < k) {
        matrix[k][k - 1u] = -(signed * size);
        matrix[k + 1u][k - 1u] = real(0.0);
        if (three) {
            matrix[k + 2u][k - 1u] = real(0.0);
        }
    }
    for (var j = k; j <= last; j++) {
        if (three) {
            let share = matrix[k][j] + v1 * matrix[k + 1u][j] + v2 * matrix[k + 2u][j];
            matrix[k][j] -= w0 * share;
            matrix[k + 1u][j] -= w1 * share;
            matrix[k + 2u][j] -= w2 * share;
        } else {
            let share = matrix[k][j] + v1 * matrix[k + 1u][j];
            matrix[k][j] -= w0 * share;
            matrix[k + 1u][j] -= w1 * share;
        }
    }
    for (var i = start; i <= min(last, k + 3u); i++) {
        if (three) {
            let share = w0 * matrix[i][k] + w1 * matrix[i][k + 1u] + w2 * matrix[i][k + 2u];
            matrix[i][k] -= share;
            matrix[i][k + 1u] -= share * v1;
            matrix[i][k + 2u] -= share * v2;
        } else {
            let share = w0 * matrix[i][k] + w1 * matrix[i][k + 1u];
            matrix[i][k] -= share;
            matrix[i][k + 1u] -= share * v1;
        }
    }
}
