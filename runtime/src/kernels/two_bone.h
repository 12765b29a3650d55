// Two bones in closed form. Included in a namespace of its own for each kind of Number: a double, or several in lanes,
// one per limb. That namespace also defines Mask, a boolean per lane, and the functions of both. All of
// them round every operation, so that a lane computes the same bits as a single limb.

// NOLINTBEGIN(misc-definitions-in-headers): included once, in an unnamed namespace

struct Vector {
    Number x, y, z;
};

struct Rotation {
    Number x, y, z, w;
};

BENDY_ALWAYS_INLINE Vector operator+(const Vector& a, const Vector& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
BENDY_ALWAYS_INLINE Vector operator-(const Vector& a, const Vector& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
BENDY_ALWAYS_INLINE Vector operator*(const Vector& v, Number number) {
    return {v.x * number, v.y * number, v.z * number};
}
BENDY_ALWAYS_INLINE Vector scaled(const Vector& a, const Vector& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
BENDY_ALWAYS_INLINE Number dot(const Vector& a, const Vector& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
BENDY_ALWAYS_INLINE Vector cross(const Vector& a, const Vector& b) {
    return {a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y};
}
BENDY_ALWAYS_INLINE Number squared(const Vector& v) {
    return dot(v, v);
}
BENDY_ALWAYS_INLINE Number squared(const Rotation& q) {
    return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
}
BENDY_ALWAYS_INLINE Rotation operator*(const Rotation& q, Number number) {
    return {q.x * number, q.y * number, q.z * number, q.w * number};
}
BENDY_ALWAYS_INLINE Rotation operator*(const Rotation& a, const Rotation& b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
            a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
BENDY_ALWAYS_INLINE Rotation conjugate(const Rotation& q) {
    return {-q.x, -q.y, -q.z, q.w};
}
BENDY_ALWAYS_INLINE Vector chosen(Mask mask, const Vector& a, const Vector& b) {
    return {chosen(mask, a.x, b.x), chosen(mask, a.y, b.y), chosen(mask, a.z, b.z)};
}
BENDY_ALWAYS_INLINE Rotation chosen(Mask mask, const Rotation& a, const Rotation& b) {
    return {chosen(mask, a.x, b.x), chosen(mask, a.y, b.y), chosen(mask, a.z, b.z), chosen(mask, a.w, b.w)};
}

/// Rotates a vector by a unit quaternion.
BENDY_ALWAYS_INLINE Vector turned(const Rotation& q, const Vector& v) {
    const Vector u{q.x, q.y, q.z};
    const Vector across = cross(u, v) * 2.0;
    return v + across * q.w + cross(u, across);
}

/// Normalises a quaternion. False for a zero quaternion and for NaN.
BENDY_ALWAYS_INLINE Mask normalize(Rotation& q) {
    const Number length = squared(q);
    q = q * (1.0 / root(length));
    constexpr double kLeast = 1e-200, kMost = 1e200;
    return both(length > Number(kLeast), length < Number(kMost));
}

/// Normalises a joint's rotation; false if its length is off by more than rounding.
BENDY_ALWAYS_INLINE Mask normalize_local(Rotation& q) {
    const Number off = squared(q) - 1.0;
    constexpr double kMost = 1e-5;
    q = q * (1.0 - 0.5 * off);
    return absolute(off) < Number(kMost);
}

/// Computes the unit normal of the plane through two directions; false if they are (nearly) parallel.
BENDY_ALWAYS_INLINE Mask find_normal(const Vector& a, const Vector& b, Vector& normal) {
    constexpr double kClear = 1e-12;
    normal = cross(a, b);
    const Number size = squared(normal);
    normal = normal * (1.0 / root(size));
    return size > kClear * squared(a) * squared(b);
}

/// Returns the rotation with these unit x, y and z axes, with the sign nearest to `like`. By Shepperd, "Quaternion from
/// Rotation Matrix", 1978.
BENDY_ALWAYS_INLINE Rotation rotation_of(const Vector& x, const Vector& y, const Vector& z, const Rotation& like) {
    const Number by_x = x.x - y.y - z.z, by_y = y.y - x.x - z.z, by_z = z.z - x.x - y.y, by_w = x.x + y.y + z.z;
    const Mask is_x = by_x > by_w, is_z_or_y = greater(by_y, by_z) > greater(by_x, by_w), is_z = by_z > by_y;
    const Number most = greater(greater(by_x, by_w), greater(by_y, by_z)) + 1.0;
    const Number less_x = y.z - z.y, less_y = z.x - x.z, less_z = x.y - y.x;
    const Number xy = x.y + y.x, xz = z.x + x.z, yz = y.z + z.y;
    const Rotation of_w_or_x = chosen(is_x, Rotation{most, xy, xz, less_x}, Rotation{less_x, less_y, less_z, most});
    const Rotation of_y_or_z = chosen(is_z, Rotation{xz, yz, most, less_z}, Rotation{xy, most, yz, less_y});
    const Rotation q = chosen(is_z_or_y, of_y_or_z, of_w_or_x);
    const Number scale = 0.5 / root(most);
    const Number same = q.w * like.w + q.x * like.x + q.y * like.y + q.z * like.z;
    return q * chosen(same < Number(0.0), -scale, scale);
}

/// A vector at right angles to a unit axis, turned about it.
BENDY_ALWAYS_INLINE Vector rolled(const Vector& v, const Vector& axis, Number cosine, Number sine) {
    return v * cosine + cross(axis, v) * sine;
}

/// Whether all axes have one scale, to within `same` of it.
BENDY_ALWAYS_INLINE Mask is_even(const Vector& scale, Number same) {
    return both(scale.x > Number(0.0),
                both(absolute(scale.x - scale.y) <= same * scale.x, absolute(scale.x - scale.z) <= same * scale.x));
}

BENDY_ALWAYS_INLINE Number mean_of(const Vector& v) {
    return (v.x + v.y + v.z) / 3.0;
}

struct Space {
    Vector x, y, z, origin;
};

/// Quantities derived from a limb.
struct Reaching {
    Vector way;       ///< start to target, or to where the target's softness lets the tip go; in base space
    Number distance;  ///< its squared length
    Number beyond;    ///< from there to the target, as a share of `way`
    Vector rest;      ///< middle to tip, in the start's space
    Rotation upper, lower;
};

/// How the middle joint bends: the rest of the chain rotates about a unit axis, relative to the start.
struct Bend {
    Vector bone;     ///< start to middle
    Vector axis;     ///< of the rotation
    Vector across;   ///< middle to tip: the part that rotates
    Vector along;    ///< middle to tip: the part along the axis
    Number b, c;     ///< component of the rotated `across` along the bone, at an angle: b cos + c sin
    Number wanted;   ///< the required value of that
    Number most;     ///< b^2 + c^2
    Number opening;  ///< sqrt(most - wanted^2): the opening to either side of the straight chain
};

struct Turn {
    Number cosine, sine;
};

using Limbs = TwoBoneLimbs<kLimbs>;

BENDY_ALWAYS_INLINE Number load(const double (&from)[1][kLimbs]) {
    return loaded(from[0]);
}
BENDY_ALWAYS_INLINE Vector load(const double (&from)[3][kLimbs]) {
    return {loaded(from[0]), loaded(from[1]), loaded(from[2])};
}
BENDY_ALWAYS_INLINE Rotation load(const double (&from)[4][kLimbs]) {
    return {loaded(from[0]), loaded(from[1]), loaded(from[2]), loaded(from[3])};
}
BENDY_ALWAYS_INLINE Mask load_flag(const double (&from)[1][kLimbs]) {
    return load(from) > Number(0.0);
}
BENDY_ALWAYS_INLINE Space load_base(const Limbs& limb) {
    return {load(limb.base_x), load(limb.base_y), load(limb.base_z), load(limb.base_origin)};
}

/// Converts a point from model space to base space; not finite if the base is flat.
BENDY_ALWAYS_INLINE Vector from_model(const Space& base, const Vector& point) {
    const Vector way = point - base.origin;
    const Vector across = cross(base.y, base.z);
    const Number volume = 1.0 / dot(base.x, across);
    return Vector{dot(way, across), dot(way, cross(base.z, base.x)), dot(way, cross(base.x, base.y))} * volume;
}

/// Converts a vector from base space to model space.
BENDY_ALWAYS_INLINE Vector to_model(const Space& base, const Vector& way) {
    return base.x * way.x + base.y * way.y + base.z * way.z;
}

/// Returns the tolerance in base space, given that in metres, if there is one, and the limb's length in base space.
BENDY_ALWAYS_INLINE Number tolerance_in(const Space& base, Number metres, Number length) {
    constexpr double kOfLength = 1e-4, kLeast = 1e-9;
    const Number scale = greater(squared(base.x), greater(squared(base.y), squared(base.z)));
    return chosen(metres > Number(0.0), greater(metres / root(scale), kLeast * length), kOfLength * length);
}

/// Returns how far a chain goes towards a target at a distance: near its full length more and more slowly, and never
/// farther than that. The zone in which it is slower has a length of its own; 0: there is none.
BENDY_ALWAYS_INLINE Number softened(Number distance, Number full, Number zone) {
    const Number past = distance - (full - zone);
    const Number soft = full - zone + zone * (past / (zone + past));
    return chosen(both(zone > Number(0.0), past > Number(0.0)), soft, distance);
}

/// Finds the bones and the way to the target. False if these are not two bones of even scale.
BENDY_ALWAYS_INLINE Mask begin(const Limbs& limb, Reaching& reach, Bend& bend) {
    reach.upper = load(limb.upper);
    reach.lower = load(limb.lower);
    const Vector upper_scale = load(limb.upper_scale), lower_scale = load(limb.lower_scale);
    const Number same = load(limb.same_scale);
    const Mask are_units = both(normalize_local(reach.upper), normalize_local(reach.lower));
    reach.way = from_model(load_base(limb), load(limb.target)) - load(limb.origin);
    reach.distance = squared(reach.way);
    bend.axis = load(limb.axis);
    bend.bone = scaled(upper_scale, load(limb.middle));
    reach.rest = turned(reach.lower, scaled(lower_scale * mean_of(upper_scale), load(limb.tip)));
    const Number full = root(squared(bend.bone)) + root(squared(reach.rest));
    const Number far = root(reach.distance);
    const Number soft = softened(far, full, full * load(limb.softness));
    const Number share = soft / far;
    const Mask is_soft = soft < far;
    reach.beyond = chosen(is_soft, far / soft - 1.0, Number(0.0));
    reach.way = chosen(is_soft, reach.way * share, reach.way);
    reach.distance = chosen(is_soft, soft * soft, reach.distance);
    return both(are_units, both(is_even(upper_scale, same), is_even(lower_scale, same)));
}

constexpr double kStraight = 1e-8;

/// Finds a bend about the normal of the limb as it is; false if that is straight.
BENDY_ALWAYS_INLINE Mask find_free_bend(const Vector& rest, Number sizes, Bend& bend) {
    const Vector normal = cross(bend.bone, rest);
    const Number size = squared(normal);
    const Number length = root(size);
    bend.across = rest;
    bend.along = {0.0, 0.0, 0.0};
    bend.c = -length;
    bend.axis = normal * (1.0 / length);
    bend.b = dot(bend.bone, rest);
    bend.most = sizes;
    return size > kStraight * sizes;
}

/// Finds a bend about the axis that is set.
BENDY_ALWAYS_INLINE void find_fixed_bend(const Vector& rest, Bend& bend) {
    bend.along = bend.axis * dot(rest, bend.axis);
    bend.across = rest - bend.along;
    bend.b = dot(bend.bone, bend.across);
    bend.c = dot(bend.bone, cross(bend.axis, bend.across));
    bend.most = bend.b * bend.b + bend.c * bend.c;
}

/// Finds how far a bend opens for the tip to be that far from the start, squared. Returns what is left of the rotated
/// bone: negative if the limb cannot have that length.
BENDY_ALWAYS_INLINE Number find_opening(const Vector& rest, Number distance, Bend& bend) {
    const Number along = dot(bend.bone, bend.along);
    bend.wanted = 0.5 * (distance - squared(bend.bone) - squared(rest)) - along;
    const Number left = bend.most - bend.wanted * bend.wanted;
    bend.opening = root(left);
    return left;
}

/// Completes a bend whose `bone` and, if it is fixed, `axis` are set. False if the limb is straight or cannot have the
/// length that it needs.
BENDY_ALWAYS_INLINE Mask find_bend(const Reaching& reach, Mask is_fixed, Bend& bend) {
    const Number sizes = squared(bend.bone) * squared(reach.rest);
    Mask is_bent = is_fixed;
    Bend fixed = bend;
    if (is_any(is_fixed)) find_fixed_bend(reach.rest, fixed);
    if (!is_every(is_fixed)) is_bent = either(find_free_bend(reach.rest, sizes, bend), is_bent);
    bend.axis = chosen(is_fixed, fixed.axis, bend.axis);
    bend.across = chosen(is_fixed, fixed.across, bend.across);
    bend.along = chosen(is_fixed, fixed.along, bend.along);
    bend.b = chosen(is_fixed, fixed.b, bend.b);
    bend.c = chosen(is_fixed, fixed.c, bend.c);
    bend.most = chosen(is_fixed, fixed.most, bend.most);
    const Number left = find_opening(reach.rest, reach.distance, bend);
    return both(is_bent, both(bend.most > kStraight * sizes, left > kStraight * bend.most));
}

/// Returns the rotations to either side: the smaller one first, or the preferred one if they are equal. Without a fixed
/// axis, both are the one that needs no rotation of the start by half a revolution.
BENDY_ALWAYS_INLINE void find_turns(const Bend& bend, Mask is_fixed, Mask prefers_back, Turn* turns) {
    const Number share = 1.0 / bend.most;
    const Number b = bend.b * bend.wanted, c = bend.c * bend.opening;
    const Number d = bend.c * bend.wanted, e = bend.b * bend.opening;
    const Turn back{(b - c) * share, (d + e) * share};
    const Turn ahead{(b + c) * share, (d - e) * share};
    constexpr double kSame = 1e-6;
    const Number gain = ahead.cosine - back.cosine;
    const Mask is_ahead = both(is_fixed, chosen(absolute(gain) > Number(kSame), gain > Number(0.0), prefers_back));
    turns[0] = {chosen(is_ahead, ahead.cosine, back.cosine), chosen(is_ahead, ahead.sine, back.sine)};
    const Mask is_other = both(is_fixed, opposite(is_ahead));
    turns[1] = {chosen(is_other, ahead.cosine, back.cosine), chosen(is_other, ahead.sine, back.sine)};
}

/// Whether the target is farther from the start than the limb is long.
BENDY_ALWAYS_INLINE Mask is_out_of_reach(const Limbs& limb, const Bend& bend, const Reaching& reach) {
    const Number full = root(squared(bend.bone)) + root(squared(reach.rest));
    const Number far = root(reach.distance) * (1.0 + reach.beyond);
    return far > full + tolerance_in(load_base(limb), load(limb.tolerance), full);
}

/// Computes the middle joint's rotation after the turn; false if the turn is half a revolution.
BENDY_ALWAYS_INLINE Mask turn_middle(const Bend& bend, const Turn& turn, const Rotation& before, Rotation& after) {
    const Vector by = bend.axis * turn.sine;
    const Number open = 1.0 + turn.cosine;
    after = Rotation{by.x, by.y, by.z, open} * before;
    constexpr double kHalfAround = 1e-9;
    const Mask is_whole = normalize(after);
    return both(is_whole, open > Number(kHalfAround));
}

/// Returns where the tip is after the turn, relative to the start, in the start's space.
BENDY_ALWAYS_INLINE Vector tip_after(const Bend& bend, const Turn& turn) {
    return bend.bone + bend.along + bend.across * turn.cosine + cross(bend.axis, bend.across) * turn.sine;
}

/// Rotates the start by the smallest rotation that brings the tip into the direction of the target.
BENDY_ALWAYS_INLINE Mask aim_start(const Vector& reached, const Reaching& reach, Rotation& upper) {
    const Vector from = turned(upper, reached);  // has the length of `way`
    const Vector by = cross(from, reach.way);
    const Number open = reach.distance + dot(from, reach.way);
    upper = Rotation{by.x, by.y, by.z, open} * upper;
    constexpr double kOpposite = 1e-9;
    const Mask is_whole = normalize(upper);
    return both(is_whole, open > kOpposite * reach.distance);
}

/// Rotates the start from the tip's direction and the knee's side to the target's direction and the pole's side.
BENDY_ALWAYS_INLINE Mask aim_with_pole(const Limbs& limb, const Bend& bend, const Vector& reached,
                                       const Reaching& reach, Rotation& upper) {
    const Mask is_fixed = load_flag(limb.is_fixed), is_rolled = load_flag(limb.is_rolled);
    const Vector place = load(limb.pole);
    const Vector pole =
        chosen(load_flag(limb.is_pole_point), from_model(load_base(limb), place) - load(limb.origin), place);
    Vector to_z;
    Mask is_clear = find_normal(reach.way, pole, to_z);
    Vector from_z = bend.axis * -1.0;
    if (is_any(is_fixed)) {
        Vector normal;
        is_clear = both(is_clear, either(find_normal(reached, bend.bone, normal), opposite(is_fixed)));
        from_z = chosen(is_fixed, normal, from_z);
    }
    const Number unit = 1.0 / root(reach.distance);
    const Vector from_x = reached * unit, to_x = reach.way * unit;
    if (is_any(is_rolled)) {
        to_z = chosen(is_rolled, rolled(to_z, to_x, loaded(limb.roll[0]), loaded(limb.roll[1])), to_z);
    }
    const Vector from_y = cross(from_z, from_x), to_y = cross(to_z, to_x);
    upper = rotation_of(to_x * from_x.x + to_y * from_y.x + to_z * from_z.x,
                        to_x * from_x.y + to_y * from_y.y + to_z * from_z.y,
                        to_x * from_x.z + to_y * from_y.z + to_z * from_z.z, upper);
    return is_clear;
}

/// Completes a reach after the middle joint's turn. Returns the distance from the tip to the target in metres, negative
/// if the tip is not where it should be to within the tolerance.
BENDY_ALWAYS_INLINE Number finish(const Limbs& limb, const Bend& bend, const Turn& turn, Reaching& reach) {
    const Vector reached = tip_after(bend, turn);
    const Rotation before = reach.upper;
    const Mask has_pole = load_flag(limb.has_pole);
    Mask is_aimed = has_pole;
    if (is_any(has_pole)) is_aimed = both(aim_with_pole(limb, bend, reached, reach, reach.upper), has_pole);
    if (!is_every(has_pole)) {
        Rotation upper = before;
        is_aimed = either(is_aimed, both(aim_start(reached, reach, upper), opposite(has_pole)));
        reach.upper = chosen(has_pole, reach.upper, upper);
    }
    const Space base = load_base(limb);
    const Number length = root(squared(bend.bone)) + root(squared(reach.rest));
    const Number distance = root(reach.distance);
    const Number left = absolute(root(squared(reached)) - distance);  // the direction is already right
    const Number tolerance = tolerance_in(base, load(limb.tolerance), length);
    const Vector missed = to_model(base, reach.way * (left / distance + reach.beyond));
    const Mask is_there = both(is_aimed, both(left <= tolerance, squared(reach.upper) > Number(0.5)));
    return chosen(is_there, root(squared(missed)), -1.0);
}

// NOLINTEND(misc-definitions-in-headers)
