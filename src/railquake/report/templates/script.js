"use strict";
(function () {
  var page = JSON.parse(document.getElementById("charts").textContent);
  var bar = document.getElementById("command");
  var shown = bar.querySelector("code");
  var config = { responsive: true, displaylogo: false, displayModeBar: "hover",
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };

  function tell(row) {
    shown.textContent = page.command[0] + " " + row + " " + page.command[1];
    bar.hidden = false;
  }
  bar.querySelector(".close").addEventListener("click", function () { bar.hidden = true; });
  bar.querySelector(".copy").addEventListener("click", function () {
    var range = document.createRange();
    range.selectNodeContents(shown);
    getSelection().removeAllRanges();
    getSelection().addRange(range);
    document.execCommand("copy");
  });

  page.charts.forEach(function (chart) {
    var figure = document.getElementById(chart.name);
    var places = figure.querySelectorAll(".panel");
    chart.panels.forEach(function (panel, k) {
      panel.data.forEach(function (trace) {
        if (trace.customdata) { trace.meta = page.escaped; }
      });
      Plotly.newPlot(places[k], panel.data, panel.layout, config).then(function (drawn) {
        drawn.on("plotly_click", function (event) {
          var row = event.points[0].customdata;
          if (row !== undefined && row >= 0) { tell(row); }
        });
      });
    });
    figure.querySelectorAll(".legend button").forEach(function (button) {
      button.addEventListener("click", function () {
        var on = button.getAttribute("aria-pressed") === "false";
        button.setAttribute("aria-pressed", String(on));
        chart.panels.forEach(function (panel, k) {
          var which = [];
          panel.data.forEach(function (trace, j) {
            var name = button.dataset.name;
            if (trace.name === name || trace.name.endsWith(", " + name)) { which.push(j); }
          });
          if (which.length) { Plotly.restyle(places[k], { visible: on }, which); }
        });
      });
    });
  });
  function fit() {
    document.querySelectorAll(".panel").forEach(function (panel) { Plotly.Plots.resize(panel); });
  }
  window.addEventListener("beforeprint", fit);
  window.addEventListener("afterprint", fit);
})();
