"""The element fosssim-report of PrairieLearn: what fosssim-oracle says of a submission, in the submission panel.

It reads the results of the external grader, and nothing else. Groups that students do not see are not in them.
"""
import chevron


def number(value):
    return f"{value:.2f}".rstrip("0").rstrip(".")


def points(one):
    reached = one.get("points")
    return f"{'no' if reached is None else number(reached)} of {number(one['max_points'])}"


def scene(test):
    return {
        "name": test["name"],
        "verdict": test["description"],
        "points": points(test),
        "message": test["message"],
        "output": test["output"],
    }


def group(one, tests):
    own = [test for test in tests if test["group"] == one["name"]]
    wrong = [test for test in own if test.get("points") != test["max_points"]]
    right = [test for test in own if test not in wrong]
    is_right = one["verdict"] == "accepted"
    return {
        "name": one["name"],
        "verdict": one["verdict"],
        "points": points(one),
        "color": "success" if is_right else "danger",
        "wrong": [scene(test) for test in wrong],
        "has_wrong": bool(wrong),
        "right": ", ".join(test["name"] for test in right),
        "right_count": len(right),
        "has_right": bool(right),
    }


def render(_element_html, data):
    feedback = data["feedback"]
    if data["panel"] != "submission" or not feedback:
        return ""
    results = feedback.get("results") or {}
    groups = results.get("groups") or []
    values = {
        "message": results.get("message") or feedback.get("message") or "The submission could not be graded.",
        "lines": [line for line in (results.get("output") or "").splitlines() if line],
        "groups": [group(one, results.get("tests") or []) for one in groups],
        "has_groups": bool(groups),
        "color": "success" if groups and all(one["verdict"] == "accepted" for one in groups) else "danger",
    }
    with open("fosssim-report.mustache", encoding="utf-8") as template:
        return chevron.render(template, values).strip()
